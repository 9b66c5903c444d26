//! Which precision a scene is given, and that it is enough.

use glam::DVec3;
use rayweave_core::precision::{Demand, F32_RATIO};
use rayweave_core::scene::{Cylinder, Plane, Sphere, Triangle};
use rayweave_core::{Precision, Scene};
use rayweave_tests::transform::{enlarged, moved};
use rayweave_tests::{errata, metrics, model, picture, scenes};

fn chosen(scene: &Scene) -> Precision {
    Demand::of(scene).precision()
}

/// Nothing at all, seen from the origin.
fn empty() -> Scene {
    let mut scene = errata::shadings().swap_remove(0).scene;
    scene.triangles.clear();
    scene.lights.clear();
    scene.camera.position = DVec3::ZERO;
    scene
}

fn ball(center: [f64; 3], radius: f64) -> Scene {
    let sphere = Sphere { center: DVec3::from_array(center), radius, material: 0 };
    Scene { spheres: vec![sphere], ..empty() }
}

/// The report's scene on a sphere as large as this instead of its floor.
fn on_a_globe(radius: f64) -> Scene {
    let mut scene = scenes::named("report");
    let floor = scene.planes.remove(0);
    let center = floor.point - radius * DVec3::Y;
    scene.spheres.push(Sphere { center, radius, material: floor.material });
    scene
}

// The rule

/// Catches a kind that does not count, a coordinate left out or taken with its sign, a radius
/// forgotten in the extent.
#[test]
fn every_kind_makes_its_demand() {
    let plane = |point| Plane { point: DVec3::from_array(point), normal: 9.0 * DVec3::Y, material: 0 };
    let tall = Cylinder {
        bottom: DVec3::new(1.0, -40.0, -2.0),
        top: DVec3::new(1.0, 3.0, -2.0),
        radius: 0.25,
        material: 0,
    };
    let vertices = [[1.0, 0.0, 0.0], [4.0, 4.0, 0.0], [1.0, 0.0, -1.0]].map(DVec3::from_array);
    let mut eye = empty();
    eye.camera.position = DVec3::new(3.0, -7.0, 5.0);
    let cases = [
        ("nothing", empty(), 0.0, f64::INFINITY),
        ("the eye", eye, 7.0, f64::INFINITY),
        ("a plane", Scene { planes: vec![plane([1.0, 2.0, -8.0])], ..empty() }, 8.0, f64::INFINITY),
        ("a sphere", ball([-5.0, 2.0, 3.0], 0.5), 5.5, 0.5),
        // The longest edge, of 5.1.
        (
            "a triangle",
            Scene { triangles: vec![Triangle { vertices, material: 0 }], ..empty() },
            4.0,
            26f64.sqrt(),
        ),
        ("a cylinder", Scene { cylinders: vec![tall], ..empty() }, 40.25, 0.25),
        (
            "the extremes of two",
            Scene { planes: vec![plane([0.0, -90.0, 0.0])], cylinders: vec![tall], ..empty() },
            90.0,
            0.25,
        ),
    ];
    for (what, scene, largest, smallest) in cases {
        assert_eq!(Demand::of(&scene), Demand { largest, smallest, extreme: largest.max(1.0) }, "{what}");
    }
}

/// Catches a bound that is off, or on the wrong side: the largest ratio that `f32` is good for.
#[test]
fn the_ratio_decides() {
    for scale in [1.0, 3.0, 1e-5, 1e5] {
        let demand = |ratio: f64| {
            let largest = ratio * scale;
            Demand { largest, smallest: scale, extreme: largest.max(1.0) }
        };
        assert_eq!(demand(F32_RATIO).precision(), Precision::F32);
        assert_eq!(demand(F32_RATIO * (1.0 + 1e-15)).precision(), Precision::F64);
    }
    assert_eq!(chosen(&ball([F32_RATIO - 1.0, 0.0, 0.0], 1.0)), Precision::F32);
    assert_eq!(chosen(&ball([1.0 - F32_RATIO, 0.0, 0.0], 1.0)), Precision::F32);
    assert_eq!(chosen(&ball([F32_RATIO, 0.0, 0.0], 1.0)), Precision::F64);
    // Planes have no size: no coordinate is too large for them.
    let floor = Plane { point: -1e8 * DVec3::Y, normal: DVec3::Y, material: 0 };
    assert_eq!(chosen(&Scene { planes: vec![floor], ..empty() }), Precision::F32);
}

/// Catches numbers whose squares overflow or vanish in `f32`.
#[test]
fn the_range_decides() {
    for (radius, expected) in [
        (1e-30, Precision::F64),
        (0.999e-9, Precision::F64),
        (1e-9, Precision::F32),
        (1e9, Precision::F32),
        (1.001e9, Precision::F64),
        (1e30, Precision::F64),
        (1e300, Precision::F64),
    ] {
        assert_eq!(chosen(&ball([0.0; 3], radius)), expected, "{radius:e}");
    }
}

/// Catches a number that is multiplied but not looked at: a light may be far beyond everything seen
/// and take no digit from it, but not so far that `f32` cannot square it.
#[test]
fn lights_and_materials_count_by_their_range() {
    type Change = fn(&mut Scene, f64);
    let changes: [(&str, Change); 5] = [
        ("a light's place", |scene, x| scene.lights[0].position.y = -x),
        ("a light's power", |scene, x| scene.lights[0].power = x),
        ("ambient", |scene, x| scene.materials[0].ambient = x),
        ("diffuse", |scene, x| scene.materials[0].diffuse = x),
        ("specular", |scene, x| scene.materials[0].specular = x),
    ];
    for (what, change) in changes {
        for (x, expected) in [(1e8, Precision::F32), (1e10, Precision::F64), (1e300, Precision::F64)] {
            let mut scene = scenes::named("report");
            change(&mut scene, x);
            assert_eq!(chosen(&scene), expected, "{what} of {x:e}");
        }
    }
}

/// Catches a rule that asks too much.
#[test]
fn the_repository_s_scenes_choose_f32() {
    for name in scenes::NAMES {
        assert_eq!(chosen(&scenes::named(name)), Precision::F32, "{name}");
    }
}

/// Catches a bound on the coordinates themselves where their ratio is meant, and the reverse.
#[test]
fn what_is_far_or_large_beside_the_small_chooses_f64() {
    let report = scenes::named("report");
    // All numbers grow alike: `f32` loses nothing.
    assert_eq!(chosen(&enlarged(&report, 1e5)), Precision::F32);
    assert_eq!(chosen(&enlarged(&report, 1e-5)), Precision::F32);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for offset in [1e5 * axis, -1e5 * axis] {
            assert_eq!(chosen(&moved(&report, offset)), Precision::F64, "{offset}");
        }
    }
    assert_eq!(chosen(&on_a_globe(1e6)), Precision::F64);
    assert_eq!(chosen(&on_a_globe(100.0)), Precision::F32);
    for scale in [1e12, 1e30, 1e-12, 1e-30] {
        assert_eq!(chosen(&enlarged(&report, scale)), Precision::F64, "{scale:e}");
    }
}

// Whether it is enough

const WIDTH: u32 = 60;
const HEIGHT: u32 = 45;

/// PSNR in `f32` and `f64`.
fn agreement(scene: &Scene) -> [f64; 2] {
    let mut scene = scene.clone();
    scene.render.antialiasing = 1;
    let truth = model::render(&scene, WIDTH, HEIGHT);
    [Precision::F32, Precision::F64]
        .map(|precision| metrics::psnr(&truth, &picture::of_scene(&scene, WIDTH, HEIGHT, precision)))
}

/// What the chosen precision has to reach. Above 60 dB a single sample decides, here one that
/// meets an edge and may fall to either side: no precision is better than another there.
const ENOUGH: f64 = 50.0;

#[track_caller]
fn assert_enough(what: &str, scene: &Scene) {
    let [narrow, wide] = agreement(scene);
    let precision = chosen(scene);
    let chosen = if precision == Precision::F32 { narrow } else { wide };
    let found = format!("{what}: {precision} of {narrow:.1} dB in f32, {wide:.1} dB in f64");
    assert!(chosen >= ENOUGH, "{found}");
    // The cheaper one may be a little worse, the dearer one not at all.
    assert!(precision == Precision::F32 || wide >= narrow.min(ENOUGH), "{found}");
}

/// Catches a rule that chooses `f32` where it shows, and an `f64` path that is no better.
#[test]
fn the_chosen_precision_is_enough() {
    for name in scenes::NAMES {
        let scene = scenes::named(name);
        for scale in [1e-25, 1e-12, 1e-5, 1.0, 1e5, 1e9, 1e12, 1e25] {
            assert_enough(&format!("{name}, {scale:e} times as large"), &enlarged(&scene, scale));
        }
        for offset in [100.0, 500.0, 1e3, 1e4, 1e5, 1e6] {
            assert_enough(&format!("{name}, moved by {offset}"), &moved(&scene, DVec3::splat(offset)));
        }
    }
    for radius in [100.0, 1e4, 1e6] {
        assert_enough(&format!("on a globe of {radius}"), &on_a_globe(radius));
    }
}

/// Catches a rule that chooses `f64` for nothing: these are wrong in `f32`.
#[test]
fn f64_is_chosen_for_a_reason() {
    let report = scenes::named("report");
    for (what, scene) in [
        ("far", moved(&report, DVec3::splat(1e5))),
        ("on a globe", on_a_globe(1e6)),
        ("vast", enlarged(&report, 1e25)),
        ("minute", enlarged(&report, 1e-25)),
    ] {
        let [narrow, wide] = agreement(&scene);
        assert!(narrow < ENOUGH && wide >= ENOUGH, "{what}: {narrow:.1} dB in f32, {wide:.1} dB in f64");
    }
}

/// Catches a scene without anything small in it that is minute all the same: squared distances to
/// the light vanish in `f32`.
#[test]
fn a_floor_alone_may_be_minute() {
    let mut scene = scenes::named("report");
    scene.spheres.clear();
    scene.triangles.clear();
    scene.cylinders.clear();
    for scale in [1e-5, 1e-12, 1e-25, 1e5, 1e12, 1e25] {
        assert_enough(&format!("a floor {scale:e} times as large"), &enlarged(&scene, scale));
    }
}

/// Catches a sun whose squared distance overflows in `f32`: the picture goes dark.
#[test]
fn a_light_may_be_very_far() {
    for distance in [1e6, 1e18, 1e20, 1e30, 1e100] {
        let mut scene = scenes::named("report");
        scene.lights[0].position = distance * DVec3::new(-0.5, 1.0, 0.7);
        assert_enough(&format!("a light {distance:e} away"), &scene);
    }
}

/// Catches a screen whose size over- or underflows in `f32`: the picture is one colour, although
/// only the proportions matter.
#[test]
fn a_screen_may_be_very_small_or_large() {
    for scale in [1e-60, 1e-30, 1e-10, 1e10, 1e30, 1e60] {
        let mut scene = scenes::named("report");
        scene.camera.focal_length *= scale;
        scene.camera.screen_width *= scale;
        assert_enough(&format!("a screen {scale:e} times as large"), &scene);
    }
}
