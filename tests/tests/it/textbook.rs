//! The textbook's formulas are right, if inexact: a comparison with wrong formulas says nothing.

use glam::{DVec3, dvec3 as v};
use rayweave_core::{Arithmetic, Formulas, Precision, Scene};
use rayweave_measure::random::SplitMix64;
use rayweave_tests::random_scene::random_scene;
use rayweave_tests::scenes::{caster, cylinder, of, plane, sphere, triangle, with};
use rayweave_tests::{image, model};

const TEXTBOOK: Arithmetic = Arithmetic { formulas: Formulas::Textbook, precision: Precision::F64 };

fn t(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<f64> {
    caster(scene, TEXTBOOK).closest_hit(origin, direction).map(|hit| hit.t)
}

/// One primitive of each kind, each across -z at a distance of `z` from 0.
fn ahead(z: f64) -> [(&'static str, Scene); 4] {
    let corners = [v(-1.0, -1.0, -z), v(1.0, -1.0, -z), v(0.0, 1.0, -z)];
    [
        ("plane", of([plane(v(0.0, 0.0, -z), DVec3::Z)])),
        ("sphere", of([sphere(v(0.0, 0.0, -z - 1.0), 1.0)])),
        ("triangle", of([triangle(corners)])),
        ("cylinder", of([cylinder(v(0.0, -1.0, -z - 1.0), 2.0, 1.0)])),
    ]
}

/// Catches a formula that is wrong and not only inexact.
#[test]
fn random_scenes_agree() {
    for seed in 100..130 {
        let mut scene = random_scene(seed);
        scene.render.antialiasing = 0;
        let found = image::of_scene(&scene, 48, 36, TEXTBOOK);
        let psnr = image::psnr(&model::render(&scene, 48, 36), &found);
        assert!(psnr >= 35.0, "seed {seed}: {psnr:.1} dB");
    }
}

/// Catches a wrong root, edge or rim: in `f64` both families find the same hits, and the textbook's
/// stay where `t` says.
#[test]
fn both_families_hit_the_same() {
    let mut random = SplitMix64::new(1);
    let mut draw = || 2.0 * random.fraction() - 1.0;
    let mut hits = [0; 4];
    for _ in 0..4000 {
        let mut p = || 4.0 * v(draw(), draw(), draw());
        let (a, b, c, d, share) = (p(), p(), p(), p(), p() / 4.0);
        let radius = 0.5 + b.length() / 2.0;
        let alone = [
            plane(a, b),
            sphere(a, radius),
            triangle([a, b, c]),
            cylinder(a, 1.0 + b.x.abs(), radius),
        ];
        for (primitive, hits) in alone.into_iter().zip(&mut hits) {
            let scene = of([primitive]);
            let within = a + (b - a) * share.x.abs() + (c - a) * share.y.abs();
            let target = if scene.triangles.is_empty() { a + (b - c) / 4.0 } else { within };
            let (origin, direction) = (d, target - d);
            let [robust, found] = [Precision::F64.into(), TEXTBOOK]
                .map(|arithmetic| caster(&scene, arithmetic).closest_hit(origin, direction));
            if robust.is_some_and(|hit| hit.t < 2e-3) {
                continue;
            }
            assert_eq!(found.is_some(), robust.is_some(), "{scene:?} {origin} {direction}");
            let (Some(found), Some(robust)) = (found, robust) else { continue };
            *hits += 1;
            assert!((found.t / robust.t - 1.0).abs() < 1e-6, "{found:?}, not {robust:?}");
            assert_eq!(found.point, origin + direction * found.t);
        }
    }
    assert!(hits.iter().all(|hits| *hits > 500), "{hits:?}");
}

/// Catches an offset of another size, or none.
#[test]
fn hits_nearer_than_the_offset_do_not_count() {
    // The caster halves this direction, in whose length the offset counts.
    for (what, scene) in ahead(4e-4) {
        assert!(t(&scene, DVec3::ZERO, -DVec3::Z).is_none_or(|t| t > 1.9), "{what}");
    }
    for (what, scene) in ahead(2e-3) {
        assert!(
            t(&scene, DVec3::ZERO, -DVec3::Z).is_some_and(|t| (t - 2e-3).abs() < 1e-9),
            "{what}"
        );
    }
    assert_eq!(t(&ahead(5e-4)[0].1, DVec3::ZERO, -DVec3::Z), None);
}

/// Catches edges, rims and outlines that do not belong to the primitive.
#[test]
fn edges_belong_to_the_primitive() {
    let [_, (_, sphere), (_, triangle), (_, cylinder)] = ahead(1.0);
    assert_eq!(t(&sphere, v(0.0, 1.0, 0.0), -DVec3::Z), Some(2.0));
    assert_eq!(t(&triangle, v(0.25, -1.0, 0.0), -DVec3::Z), Some(1.0));
    assert_eq!(t(&cylinder, v(0.0, -1.0, 0.0), -DVec3::Z), Some(1.0));
    assert_eq!(t(&cylinder, v(0.0, 1.0, 0.0), -DVec3::Z), Some(1.0));
}

/// Catches a shadow ray that ends at or beyond the light.
#[test]
fn a_surface_within_the_offset_of_a_light_hides_nothing() {
    let mut scene = of([plane(DVec3::ZERO, DVec3::Y)]);
    scene.lights[0].position = v(0.0, 4.0, 0.0);
    let color = |scene: &Scene| caster(scene, TEXTBOOK).color(v(0.0, 1.0, 0.0), -DVec3::Y);
    let ceiling = |y| with(scene.clone(), [plane(v(0.0, y, 0.0), DVec3::Y)]);
    assert_eq!(color(&ceiling(4.0 - 5e-4)), color(&scene));
    assert_ne!(color(&ceiling(4.0 - 2e-3)), color(&scene));
}
