//! The textbook's formulas are right, if inexact: nobody would be helped by a comparison with wrong
//! ones.

use glam::DVec3;
use rayweave_core::scene::{Cylinder, Plane, Sphere, Triangle};
use rayweave_core::{Arithmetic, Caster, Execution, Formulas, Precision, Scene, tracer};
use rayweave_measure::random::SplitMix64;
use rayweave_tests::scenes::empty;
use rayweave_tests::{image, metrics, model, random_scene::random_scene};

const TEXTBOOK: Arithmetic = Arithmetic { formulas: Formulas::Textbook, precision: Precision::F64 };

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn t(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<f64> {
    Caster::new(&scene.with_arithmetic(TEXTBOOK))
        .expect("a sound scene")
        .closest_hit(origin, direction)
        .map(|hit| hit.t)
}

/// One thing of each kind, each across -z at a distance of `z` from 0.
fn ahead(z: f64) -> [(&'static str, Scene); 4] {
    let corners = [v(-1.0, -1.0, -z), v(1.0, -1.0, -z), v(0.0, 1.0, -z)];
    [
        (
            "plane",
            Scene {
                planes: vec![Plane { point: v(0.0, 0.0, -z), normal: DVec3::Z, material: 0 }],
                ..empty()
            },
        ),
        (
            "sphere",
            Scene {
                spheres: vec![Sphere { center: v(0.0, 0.0, -z - 1.0), radius: 1.0, material: 0 }],
                ..empty()
            },
        ),
        (
            "triangle",
            Scene { triangles: vec![Triangle { vertices: corners, material: 0 }], ..empty() },
        ),
        (
            "cylinder",
            Scene {
                cylinders: vec![Cylinder {
                    bottom: v(0.0, -1.0, -z - 1.0),
                    top: v(0.0, 1.0, -z - 1.0),
                    radius: 1.0,
                    material: 0,
                }],
                ..empty()
            },
        ),
    ]
}

/// Catches a formula that is wrong and not only inexact.
#[test]
fn random_scenes_agree() {
    for seed in 100..130 {
        let mut scene = random_scene(seed);
        scene.render.antialiasing = 0;
        let work = tracer(&scene.with_arithmetic(TEXTBOOK), 48, 36, Execution::default())
            .expect("a sound scene");
        let psnr =
            metrics::psnr(&model::render(&scene, 48, 36), &image::pixel_by_pixel(&*work, 48, 36));
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
        let things = [
            Scene { planes: vec![Plane { point: a, normal: b, material: 0 }], ..empty() },
            Scene {
                spheres: vec![Sphere { center: a, radius: 0.5 + b.length() / 2.0, material: 0 }],
                ..empty()
            },
            Scene { triangles: vec![Triangle { vertices: [a, b, c], material: 0 }], ..empty() },
            Scene {
                cylinders: vec![Cylinder {
                    bottom: a,
                    top: a + (1.0 + b.x.abs()) * DVec3::Y,
                    radius: 0.5 + b.length() / 2.0,
                    material: 0,
                }],
                ..empty()
            },
        ];
        for (scene, hits) in things.iter().zip(&mut hits) {
            let within = a + (b - a) * share.x.abs() + (c - a) * share.y.abs();
            let target = if scene.triangles.is_empty() { a + (b - c) / 4.0 } else { within };
            let (origin, direction) = (d, target - d);
            let robust = Caster::new(&scene.with_arithmetic(Precision::F64))
                .expect("a sound scene")
                .closest_hit(origin, direction);
            let found = Caster::new(&scene.with_arithmetic(TEXTBOOK))
                .expect("a sound scene")
                .closest_hit(origin, direction);
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

/// Catches edges, rims and outlines that do not belong to the thing.
#[test]
fn edges_belong_to_the_thing() {
    let [_, (_, sphere), (_, triangle), (_, cylinder)] = ahead(1.0);
    assert_eq!(t(&sphere, v(0.0, 1.0, 0.0), -DVec3::Z), Some(2.0));
    assert_eq!(t(&triangle, v(0.25, -1.0, 0.0), -DVec3::Z), Some(1.0));
    assert_eq!(t(&cylinder, v(0.0, -1.0, 0.0), -DVec3::Z), Some(1.0));
    assert_eq!(t(&cylinder, v(0.0, 1.0, 0.0), -DVec3::Z), Some(1.0));
}

/// Catches a shadow ray that ends at or beyond the light.
#[test]
fn what_is_within_the_offset_of_a_light_hides_nothing() {
    let mut scene = Scene {
        planes: vec![Plane { point: DVec3::ZERO, normal: DVec3::Y, material: 0 }],
        ..empty()
    };
    scene.lights.truncate(1);
    scene.lights[0].position = v(0.0, 4.0, 0.0);
    let color = |scene: &Scene| {
        Caster::new(&scene.with_arithmetic(TEXTBOOK))
            .expect("a sound scene")
            .color(v(0.0, 1.0, 0.0), -DVec3::Y)
    };
    let lit = color(&scene);
    let ceiling = |y| Scene {
        planes: vec![
            scene.planes[0],
            Plane { point: v(0.0, y, 0.0), normal: DVec3::Y, material: 0 },
        ],
        ..scene.clone()
    };
    assert_eq!(color(&ceiling(4.0 - 5e-4)), lit);
    assert_ne!(color(&ceiling(4.0 - 2e-3)), lit);
}
