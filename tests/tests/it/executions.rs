//! The execution changes no bit of an image: rays one by one or in packets, samples of each pixel's
//! own or shared, all primitives or only candidates tried, in tiles of any size.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_accuracy::metrics::ImageDifference;
use rayweave_core::scene::RenderSettings;
use rayweave_core::{Arithmetic, Execution, Formulas, Lanes, Precision, Sampling, Scene};
use rayweave_tests::image::{difference, executions, in_tiles, plain};
use rayweave_tests::{random_scene::random_scene, scenes};

const ARITHMETICS: [Arithmetic; 4] = [
    Arithmetic { formulas: Formulas::Robust, precision: Precision::F32 },
    Arithmetic { formulas: Formulas::Robust, precision: Precision::F64 },
    Arithmetic { formulas: Formulas::Textbook, precision: Precision::F32 },
    Arithmetic { formulas: Formulas::Textbook, precision: Precision::F64 },
];

/// The whole image as one tile, tiles that packets and strips do not fit, and single pixels.
const TILES: [u32; 3] = [1000, 7, 1];

/// Asserts that every execution, in tiles of every size, gives the bits of the plain one.
fn executions_agree(scene: &Scene, size: (u32, u32), arithmetic: Arithmetic, name: &str) {
    let scene = &scene.with_arithmetic(arithmetic);
    let right = in_tiles(scene, size, plain(), 1);
    for execution in executions() {
        for tile in TILES {
            let found = in_tiles(scene, size, execution, tile);
            if let Some(difference) = difference(&found, &right) {
                panic!("{name}, {execution:?}, tiles of {tile}: {difference}");
            }
        }
    }
}

/// Catches a packet whose lanes are mixed up or rounded another way, a lattice point that goes to a
/// wrong pixel, and a hit or a shadow that acceleration leaves out, in the repository's scenes.
#[test]
fn the_repository_s_scenes() {
    let hard = scenes::hard().into_iter().map(|name| format!("hard/{name}"));
    for name in scenes::NAMES.map(str::to_owned).into_iter().chain(hard) {
        let mut scene = scenes::named(&name);
        scene.render.antialiasing = 1;
        for arithmetic in &ARITHMETICS[..3] {
            executions_agree(&scene, (33, 22), *arithmetic, &name);
        }
    }
}

/// Catches the same in an image larger than a strategy's tile: many strips, many batches.
#[test]
fn a_larger_image() {
    let mut scene = scenes::named("lab");
    scene.render.antialiasing = 1;
    executions_agree(&scene, (97, 75), ARITHMETICS[0], "lab");
}

/// Catches sums in another order and points in a wrong slot at a density that is even, odd, as
/// large as a block, or larger; and sharing where no point is shared.
#[test]
fn every_density() {
    for (name, sampling) in [("room", Sampling::Lattice), ("lab", Sampling::Importance)] {
        for antialiasing in [0, 1, 2, 3, 4, 5] {
            let mut scene = scenes::named(name);
            (scene.render.antialiasing, scene.render.sampling) = (antialiasing, sampling);
            for arithmetic in ARITHMETICS {
                let name = format!("{name} with {antialiasing}, {sampling}");
                executions_agree(&scene, (17, 10), arithmetic, &name);
            }
        }
    }
}

/// Catches a point that is interpolated in one tile and traced in another, where it is at an edge;
/// and a lane whose path hash is another one's.
#[test]
fn adaptive_samples() {
    for antialiasing in [1, 2, 3, 5] {
        let mut scene = scenes::named("room");
        (scene.render.antialiasing, scene.render.adaptive) = (antialiasing, true);
        for arithmetic in &ARITHMETICS[..3] {
            executions_agree(&scene, (23, 17), *arithmetic, &format!("adaptive {antialiasing}"));
        }
    }
}

/// Catches points that are interpolated across the edge of a surface, a shadow or a mirror image,
/// and interpolation that never happens.
#[test]
fn adaptive_samples_are_near_the_lattice() {
    let mut scene = scenes::named("room").with_arithmetic(ARITHMETICS[0]);
    scene.render.antialiasing = 4;
    let execution = Execution { lanes: Lanes::default(), share_samples: true, ..plain() };
    let full = in_tiles(&scene, (200, 200), execution, 64);
    scene.render.adaptive = true;
    let found = in_tiles(&scene, (200, 200), execution, 64);
    let psnr = ImageDifference::between(&full, &found).psnr();
    assert!(psnr >= 50.0, "{psnr} dB");
    assert!(found != full, "nothing is interpolated");
    // A constant image is interpolated without an error.
    let empty =
        Scene { planes: vec![], spheres: vec![], triangles: vec![], cylinders: vec![], ..scene };
    let image = in_tiles(&empty, (20, 20), execution, 7);
    let lattice = Scene { render: RenderSettings { adaptive: false, ..empty.render }, ..empty };
    assert!(image == in_tiles(&lattice, (20, 20), execution, 7));
}

/// Catches the same in images that are smaller than a packet, a block, or a row of one.
#[test]
fn small_and_narrow_images() {
    for (antialiasing, adaptive) in
        [(0, false), (1, false), (2, false), (3, false), (1, true), (2, true), (3, true)]
    {
        let mut scene = scenes::named("room");
        (scene.render.antialiasing, scene.render.adaptive) = (antialiasing, adaptive);
        for size in [(1, 1), (2, 1), (1, 2), (3, 5), (1, 40), (40, 1)] {
            for arithmetic in &ARITHMETICS[..2] {
                let name = format!("{size:?} with {antialiasing}");
                executions_agree(&scene, size, *arithmetic, &name);
            }
        }
    }
}

/// Catches samples that are lost where one pixel, or a few, have more than are traced together.
#[test]
fn many_samples_a_pixel() {
    let mut scene = scenes::named("lab");
    for (antialiasing, size) in [(9, (5, 2)), (17, (2, 2)), (32, (1, 2))] {
        for (sampling, adaptive) in
            [(Sampling::Lattice, false), (Sampling::Importance, false), (Sampling::Lattice, true)]
        {
            (scene.render.antialiasing, scene.render.sampling) = (antialiasing, sampling);
            scene.render.adaptive = adaptive;
            for arithmetic in &ARITHMETICS[..2] {
                let name = format!("{antialiasing}, {sampling}, adaptive: {adaptive}");
                executions_agree(&scene, size, *arithmetic, &name);
            }
        }
    }
}

/// Catches a test that compares an execution with itself.
#[test]
fn the_executions_are_all_there() {
    let all = executions();
    assert_eq!(all[0], plain());
    assert_eq!(all.len(), 12);
    for (i, execution) in all.iter().enumerate() {
        assert!(!all[..i].contains(execution), "{execution:?} twice");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1500,
        rng_seed: RngSeed::Fixed(2026),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Catches the same in scenes that use everything, in any execution and any tiles.
    #[test]
    fn random_scenes(
        seed in 0..1_000_000u64,
        arithmetic in 0..ARITHMETICS.len(),
        execution in 0..12usize,
        tile in 1..30u32,
        size in (1..30u32, 1..20u32),
        antialiasing in 0..4u32,
        importance in prop::bool::weighted(0.2),
    ) {
        let mut scene = random_scene(seed).with_arithmetic(ARITHMETICS[arithmetic]);
        scene.render.antialiasing = antialiasing;
        scene.render.sampling = if importance { Sampling::Importance } else { Sampling::Lattice };
        let execution = executions()[execution];
        let right = in_tiles(&scene, size, plain(), 1);
        let found = in_tiles(&scene, size, execution, tile);
        prop_assert_eq!(difference(&found, &right), None, "{:?}", execution);
    }
}
