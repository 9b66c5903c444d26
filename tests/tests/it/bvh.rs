//! The BVH leaves out only primitives that a ray does not meet: with it an image has the bits that
//! it has when each ray tries each primitive.

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_core::{Acceleration, Execution, Lanes, Scene};
use rayweave_tests::image::{accelerated, difference_from_plain, plain};
use rayweave_tests::many_primitives::{Arrangement, Shape, many_primitives, meshes};
use rayweave_tests::model::Model;
use rayweave_tests::scenes::{PRECISIONS, with};
use rayweave_tests::transform::{enlarged, moved};

#[track_caller]
fn assert_acceleration_agrees(scene: &Scene, name: &str) {
    for precision in PRECISIONS {
        let scene = scene.with_arithmetic(precision);
        assert_eq!(difference_from_plain(&scene, (24, 18), accelerated()), None, "{name}");
    }
}

/// Compares `count` primitives of every shape in every arrangement, at the origin and far from it.
fn all_agree(count: usize, seeds: std::ops::Range<u64>) {
    for (shape, arrangement) in Shape::ALL
        .into_iter()
        .flat_map(|shape| Arrangement::ALL.map(|arrangement| (shape, arrangement)))
    {
        for seed in seeds.clone() {
            let scene = many_primitives(seed, count, shape, arrangement);
            // Far away a rounding of `f32` is 1/1024, and so is a box's margin many times larger.
            let offset = if seed % 2 == 0 { DVec3::ZERO } else { DVec3::new(1e4, -7e3, 8e3) };
            let name =
                format!("{count} x {shape:?}, {arrangement:?}, seed {seed}, moved by {offset}");
            assert_acceleration_agrees(&moved(&scene, offset), &name);
        }
    }
}

/// Catches a box that is skipped though a ray meets a primitive in it, and a tie that the order of
/// traversal decides, in hierarchies of few levels.
#[test]
fn a_hundred_primitives() {
    all_agree(100, 0..6);
}

/// Catches the same in deeper hierarchies.
#[test]
fn a_thousand_primitives() {
    all_agree(1000, 6..8);
}

/// Catches a stack that overflows, or numbers of leaves that run into each other.
#[test]
fn ten_thousand_primitives() {
    for (seed, arrangement) in (0..).zip(Arrangement::ALL) {
        let scene = many_primitives(seed, 10_000, Shape::Any, arrangement);
        assert_acceleration_agrees(&scene, &format!("{arrangement:?}"));
    }
}

/// Catches a ray lost between two leaves: triangles that share edges, seen along the axes.
#[test]
fn closed_meshes() {
    for seed in 0..24 {
        let scene = meshes(seed, 1 + seed as usize % 8);
        let offset = if seed % 3 == 0 { DVec3::new(2e3, 3e3, -1e4) } else { DVec3::ZERO };
        assert_acceleration_agrees(&moved(&scene, offset), &format!("seed {seed}"));
    }
}

/// Catches a threshold that leaves a primitive out of the BVH or the list: every count around it.
#[test]
fn every_small_count() {
    for count in 1..=40 {
        for (seed, arrangement) in (0..).zip([Arrangement::Overlapping, Arrangement::Copies]) {
            let scene = many_primitives(seed, count, Shape::Any, arrangement);
            assert_acceleration_agrees(&scene, &format!("{count} x {arrangement:?}"));
        }
    }
}

/// Catches a split that never ends, and an order that nothing decides: everything in one place.
#[test]
fn one_primitive_many_times() {
    for (shape, count) in [Shape::Sphere, Shape::Triangle, Shape::Cylinder]
        .into_iter()
        .flat_map(|shape| [12, 40, 100, 1000, 3000].map(|count| (shape, count)))
    {
        let mut scene = many_primitives(3, 1, shape, Arrangement::Overlapping);
        // The camera looks at it.
        let corner = scene.triangles.first().map(|t| t.vertices.iter().sum::<DVec3>() / 3.0);
        let middle = scene.spheres.first().map(|s| s.center).or(corner);
        let axis = scene.cylinders.first().map(|c| (c.bottom + c.top) / 2.0);
        scene.camera.look_at = middle.or(axis).expect("one of them");
        let only = *Model::new(&scene).primitives.last().expect("planes come first");
        let materials = scene.materials.len();
        scene.spheres.clear();
        scene.triangles.clear();
        scene.cylinders.clear();
        let scene = with(scene, (0..count).map(|i| only.of((i + 2) % materials)));
        assert_acceleration_agrees(&scene, &format!("{count} x {shape:?}"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 800,
        rng_seed: RngSeed::Fixed(2027),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Catches the same anywhere, at every scale and distance.
    #[test]
    fn many_primitives_by_chance(
        seed: u64,
        count in 12..200usize,
        shape in prop::sample::select(Shape::ALL.to_vec()),
        arrangement in prop::sample::select(Arrangement::ALL.to_vec()),
        scale in prop_oneof![Just(1.0), 1e-3..1e3f64],
        offset in prop_oneof![Just(0.0), 1.0..1e4f64],
        precision in prop::sample::select(PRECISIONS.to_vec()),
        lanes in prop::sample::select(Lanes::ALL.to_vec()),
    ) {
        let offset = DVec3::new(offset, -0.7 * offset, 0.3 * offset);
        let scene = many_primitives(seed, count, shape, arrangement);
        let scene = enlarged(&moved(&scene, offset), scale);
        prop_assume!(scene.check().is_ok());
        let execution = Execution { lanes, acceleration: Acceleration::Auto, ..plain() };
        let scene = scene.with_arithmetic(precision);
        prop_assert_eq!(difference_from_plain(&scene, (16, 12), [execution]), None);
    }
}
