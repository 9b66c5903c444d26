//! The digests of images stay the same on every machine and in every build.
//!
//! They may change only when the meaning of an image changes: the model, a formula, an order of
//! operations. A faster way to the same image, another strategy, compiler or machine is no such
//! change. To print new digests, run `cargo test -p rayweave-tests golden`: the failure shows
//! the whole table as it has to stand here.

use rayweave_core::{Arithmetic, Formulas, Sampling, Scene};
use rayweave_tests::scenes::{self, PRECISIONS};
use rayweave_tests::{image, random_scene::random_scene};

const WIDTH: u32 = 100;
const HEIGHT: u32 = 75;

/// The first 16 digits of each digest: in `f32` without antialiasing and with 2, then in `f64`.
type Golden = (&'static str, [u64; 4]);

#[rustfmt::skip]
const GOLDEN: [Golden; 6] = [
    ("lab", [0xec7e894541cae77d, 0x78091354ea4ef08c, 0xbb5e595df8eb25ab, 0x27a91ed89c290d3a]),
    ("room", [0xf0385f984f0892d3, 0x4fc3dfb418e85bd6, 0x92b0ab31c5e977f1, 0xc087e509b8869bfc]),
    ("imbalance", [0x723242fbbdffb522, 0x4b6fa890b001baa1, 0x026870ebc1fa123a, 0x0c4e9263293a0cb1]),
    ("random 1", [0xe5c61e8eb0f406d6, 0x81b0d54b8a246bde, 0x16ad69731809da0d, 0x3998d874893c010a]),
    ("random 4", [0x48af00149bee3adb, 0x130a8eeee82b859e, 0xa9ee3994424a419a, 0x455c78df7a12842c]),
    ("random 7", [0x1287adc60f8f71a0, 0x57e12edd9eae5f8f, 0x9b87e957c9ff5582, 0xb88e1cc91b04dcfe]),
];

/// The digests with the textbook's formulas, without antialiasing: in `f32` and in `f64`.
#[rustfmt::skip]
const TEXTBOOK: [(&str, [u64; 2]); 2] = [
    ("lab", [0x9f0d2ca82b800e26, 0x4f43191bd4523d08]),
    ("room", [0x1c2df3ae0ca9c0e8, 0xa9f4854fe75fcee9]),
];

/// The lab report's scene with samples by importance, a density of 2: in `f32` and in `f64`.
const IMPORTANCE: [u64; 2] = [0x77b541ce95c7c347, 0x3481aa9114591d04];

/// The room and the lab report's scene with a density of 4, adaptive: in `f32` and in `f64`.
const ADAPTIVE: [[u64; 2]; 2] =
    [[0x53e801981c82d28d, 0xa2586d5a643b019c], [0x45ee3a9b4b7d8a47, 0x2d1ea4d9a4ec2e5a]];

fn scene(name: &str) -> Scene {
    match name.strip_prefix("random ") {
        Some(seed) => random_scene(seed.parse().expect("a number")),
        None => scenes::named(name),
    }
}

/// The first 16 hexadecimal digits of the digest of a scene's image.
fn digest(scene: &Scene, arithmetic: impl Into<Arithmetic>) -> u64 {
    let image = image::of_scene(scene, WIDTH, HEIGHT, arithmetic);
    u64::from_str_radix(&image.digest().short(), 16).expect("16 hexadecimal digits")
}

fn digests(scene: &Scene) -> [u64; 4] {
    std::array::from_fn(|i| {
        let mut scene = scene.clone();
        scene.render.antialiasing = [0, 2][i % 2];
        digest(&scene, PRECISIONS[i / 2])
    })
}

/// Catches any change of a bit: a formula rearranged, a sum in another order, a multiply-add, a
/// `libm` of the system's, an optimisation that rounds differently.
#[test]
fn images_stay_what_they_are() {
    let found = GOLDEN.map(|(name, _)| (name, digests(&scene(name))));
    let table: String = found
        .iter()
        .map(|(name, [a, b, c, d])| {
            format!("    ({name:?}, [{a:#018x}, {b:#018x}, {c:#018x}, {d:#018x}]),\n")
        })
        .collect();
    assert!(found == GOLDEN, "the images are now\n{table}");
}

/// Catches the same in the textbook's formulas.
#[test]
fn textbook_images_stay_what_they_are() {
    let found = TEXTBOOK.map(|(name, _)| {
        let mut scene = scene(name);
        scene.render.antialiasing = 0;
        let digests = PRECISIONS.map(|precision| {
            digest(&scene, Arithmetic { formulas: Formulas::Textbook, precision })
        });
        (name, digests)
    });
    assert!(found == TEXTBOOK, "the images are now {found:#018x?}");
}

/// Catches the same in sampling by importance: a quantile from the system's library, another
/// generator.
#[test]
fn importance_images_stay_what_they_are() {
    let mut scene = scene("lab");
    scene.render.antialiasing = 2;
    scene.render.sampling = Sampling::Importance;
    let found = PRECISIONS.map(|precision| digest(&scene, precision));
    assert!(found == IMPORTANCE, "the images are now {found:#018x?}");
}

/// Catches points that are interpolated by another rule, or elsewhere.
#[test]
fn adaptive_images_stay_what_they_are() {
    let found = ["room", "lab"].map(|name| {
        let mut scene = scene(name);
        (scene.render.antialiasing, scene.render.adaptive) = (4, true);
        PRECISIONS.map(|precision| digest(&scene, precision))
    });
    assert!(found == ADAPTIVE, "the images are now {found:#018x?}");
}

/// Catches a table that cannot fail: a digest that is the same for two images, because the scene
/// was not used, or the precision, or the antialiasing.
#[test]
fn no_two_images_are_the_same() {
    let mut all: Vec<_> = GOLDEN.iter().flat_map(|(_, digests)| digests).collect();
    all.sort_unstable();
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
}
