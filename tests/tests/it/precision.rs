//! The precision chosen for a scene is right, and it is enough.

use glam::{DVec3, dvec3 as v};
use rayweave_core::precision::{F32_DISPLACEMENT, F32_MIRRORS, PrecisionEstimate};
use rayweave_core::scene::Material;
use rayweave_core::{Lanes, Precision, Scene};
use rayweave_tests::model::{self, Primitive};
use rayweave_tests::scenes::{cylinder, empty, named, plane, sphere, triangle, with};
use rayweave_tests::transform::{enlarged, moved};
use rayweave_tests::{image, scenes};

fn chosen(scene: &Scene) -> Precision {
    PrecisionEstimate::of(scene).precision()
}

/// A scene of these primitives, without a light, seen from `eye`.
fn seen_from(eye: DVec3, primitives: &[Primitive]) -> Scene {
    let mut scene = with(empty(), primitives.iter().copied());
    scene.lights.clear();
    scene.camera.position = eye;
    scene
}

/// The lab report's scene on a sphere of this radius instead of its floor.
fn on_a_globe(radius: f64) -> Scene {
    let mut scene = named("lab");
    let floor = scene.planes.remove(0);
    with(scene, [sphere(floor.point - radius * DVec3::Y, radius).of(floor.material)])
}

/// The scene through a lens that shows an image as wide as it is far away.
fn through_a_lens(focal_length: f64, mut scene: Scene) -> Scene {
    scene.camera.focal_length = focal_length;
    scene.camera.screen_width = 1.0;
    scene
}

/// The lab report's scene from this distance, through a lens that makes it as large as ever.
fn from_afar(distance: f64) -> Scene {
    let mut scene = named("hard/telephoto");
    let camera = &mut scene.camera;
    camera.position = camera.look_at + distance * (camera.position - camera.look_at).normalize();
    camera.focal_length = distance;
    scene
}

// The rule

/// Catches a kind that does not count, a coordinate left out or taken with its sign, a radius
/// forgotten in the extent, a distance to the wrong point of a primitive.
#[test]
fn every_kind_takes_digits() {
    let across = |point| plane(point, 9.0 * DVec3::Y);
    let tall = cylinder(v(3.0, -40.0, -4.0), 43.0, 0.25);
    let low = cylinder(v(0.0, 2.0, 0.0), 1.0, 0.25);
    let corners = |x: f64, y: f64| [v(x - 3.0, y, -4.0), v(x + 6.0, y, -4.0), v(x - 3.0, y, 4.0)];
    let (zero, high) = (DVec3::ZERO, 65f64.sqrt() / 4.0);
    let eye = v(3.0, -7.0, 5.0);
    let around = [sphere(v(-3.0, 0.0, 4.0), 7.0)];
    // The expected roundings are 24 of the extent across, one of that along, four of the distance.
    // Then come the distance, the smallest number that is squared, and the largest number.
    let cases: [(_, _, &[_], _, _, _, _); 11] = [
        ("nothing", zero, &[], 4.0, 1.0, f64::INFINITY, 1.0),
        ("the eye", eye, &[], 4.0, 1.0, 7.0, 7.0),
        ("a plane", zero, &[across(v(100.0, 2.0, -8.0))], 24.0 * 2.0 + 8.0, 2.0, 100.0, 100.0),
        ("a sphere", zero, &[sphere(v(-3.0, 0.0, 4.0), 0.5)], 96.0 + 4.5 + 18.0, 4.5, 0.5, 4.5),
        ("a sphere around the eye", zero, &around, 24.0 * 7.0 + 11.0 + 8.0, 2.0, 7.0, 11.0),
        // Below its middle, the eye's height counts; beside it, the distance to a corner.
        ("a triangle", zero, &[triangle(corners(0.0, -2.0))], 48.0 + 6.0 + 8.0, 2.0, 6.0, 6.0),
        ("a triangle aside", zero, &[triangle(corners(6.0, 0.0))], 12.0 + 12.0, 3.0, 12.0, 12.0),
        ("a cylinder", zero, &[tall], 24.0 * 4.0 + 40.25 + 19.0, 4.75, 0.25, 40.25),
        ("a cylinder above", zero, &[low], 24.0 * 0.25 + 3.25 + 4.0 * high, high, 0.25, 3.25),
        ("a far eye", eye, &[sphere(v(3.0, -7.0, 1.0), 1.0)], 168.0 + 8.0 + 12.0, 3.0, 1.0, 8.0),
        (
            "the worst of two",
            zero,
            &[across(v(0.0, -90.0, 0.0)), tall],
            24.0 * 4.0 + 40.25 + 19.0,
            4.75,
            0.25,
            90.0,
        ),
    ];
    for (what, eye, primitives, roundings, distance, least, extreme) in cases {
        let scene = seen_from(eye, primitives);
        for focal_length in [1.0, 64.0] {
            let found = PrecisionEstimate::of(&through_a_lens(focal_length, scene.clone()));
            let displacement = focal_length * roundings / distance / 2f64.powi(24);
            assert!(
                (found.displacement / displacement - 1.0).abs() < 1e-12,
                "{what}: {found:?}, not {displacement}"
            );
            assert_eq!((found.least, found.extreme), (least, extreme), "{what}");
        }
    }
}

/// Catches a bound that is off, or on the wrong side.
#[test]
fn the_displacement_and_the_mirrors_decide() {
    let estimate = |displacement, mirrors| PrecisionEstimate {
        displacement,
        mirrors,
        least: 1.0,
        extreme: 1.0,
    };
    let more = 1.0 + 1e-15;
    assert_eq!(estimate(F32_DISPLACEMENT, F32_MIRRORS).precision(), Precision::F32);
    assert_eq!(estimate(F32_DISPLACEMENT * more, 0.0).precision(), Precision::F64);
    assert_eq!(estimate(0.0, F32_MIRRORS * more).precision(), Precision::F64);
    // Packets, whatever else asks for `f64`, except between mirrors that scatter.
    assert_eq!(Lanes::suggested(&estimate(F32_DISPLACEMENT * more, F32_MIRRORS)), Lanes::default());
    assert_eq!(Lanes::suggested(&estimate(0.0, F32_MIRRORS * more)), Lanes::One);
    // Planes without anything beside them have no outline: no coordinate is too large for them.
    let floor = plane(-1e8 * DVec3::Y, DVec3::Y);
    assert_eq!(chosen(&seen_from(DVec3::ZERO, &[floor])), Precision::F32);
}

/// Catches a flat mirror that counts, a curved one that does not, the wrong one of several.
#[test]
fn curved_mirrors_take_digits() {
    let mirrors = |reflections: [f64; 4]| {
        let mut scene = named("lab");
        scene.materials.truncate(1);
        scene.materials =
            reflections.map(|reflection| Material { reflection, ..scene.materials[0] }).into();
        scene.planes.iter_mut().for_each(|plane| plane.material = 0);
        scene.spheres.iter_mut().for_each(|sphere| sphere.material = 1);
        scene.triangles.iter_mut().for_each(|triangle| triangle.material = 2);
        scene.cylinders.iter_mut().for_each(|cylinder| cylinder.material = 3);
        scene.render.max_reflections = 5;
        PrecisionEstimate::of(&scene).mirrors
    };
    assert_eq!(mirrors([1.0, 0.0, 1.0, 0.0]), 0.0);
    assert_eq!(mirrors([0.0, 0.125, 0.0, 0.0625]), 0.0);
    assert_eq!(mirrors([0.0, 0.5, 0.0, 0.25]), 10.0);
    assert_eq!(mirrors([0.0, 0.5, 0.0, 1.0]), 15.0);
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
        assert_eq!(
            chosen(&seen_from(DVec3::ZERO, &[sphere(DVec3::ZERO, radius)])),
            expected,
            "{radius:e}"
        );
    }
}

/// Catches a number that is multiplied but not looked at. A light may be far beyond everything
/// visible and take no digit from it, but not so far that `f32` cannot square it.
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
        for (x, expected) in
            [(1e8, Precision::F32), (1e10, Precision::F64), (1e300, Precision::F64)]
        {
            let mut scene = named("lab");
            change(&mut scene, x);
            assert_eq!(chosen(&scene), expected, "{what} of {x:e}");
        }
    }
}

/// Catches a rule that asks too much, or too little of mirrors.
#[test]
fn only_the_chaotic_scene_of_the_repository_chooses_f64() {
    for name in scenes::NAMES {
        let expected = if name == "imbalance" { Precision::F64 } else { Precision::F32 };
        assert_eq!(chosen(&named(name)), expected, "{name}");
    }
}

/// Catches a bound on the coordinates themselves where they are compared with the visible part of
/// the scene, and the reverse.
#[test]
fn far_or_large_beside_small_chooses_f64() {
    let report = named("lab");
    // All numbers grow alike: `f32` loses nothing.
    assert_eq!(chosen(&enlarged(&report, 1e5)), Precision::F32);
    assert_eq!(chosen(&enlarged(&report, 1e-5)), Precision::F32);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for offset in [1e5 * axis, -1e5 * axis] {
            assert_eq!(chosen(&moved(&report, offset)), Precision::F64, "{offset}");
        }
        assert_eq!(chosen(&moved(&report, 100.0 * axis)), Precision::F32, "{axis}");
    }
    assert_eq!(chosen(&on_a_globe(1e4)), Precision::F64);
    assert_eq!(chosen(&on_a_globe(100.0)), Precision::F32);
    assert_eq!(chosen(&from_afar(1e4)), Precision::F64);
    assert_eq!(chosen(&from_afar(1e3)), Precision::F32);
    for scale in [1e12, 1e30, 1e-12, 1e-30] {
        assert_eq!(chosen(&enlarged(&report, scale)), Precision::F64, "{scale:e}");
    }
}

/// Catches a reason that does not name what decides, or is not a number.
#[test]
fn the_reason_is_one_line_about_what_decides() {
    let report = named("lab");
    for (scene, word) in [
        (&report, "of the image's width"),
        (&moved(&report, DVec3::splat(1e5)), "of the image's width"),
        (&named("imbalance"), "mirrors"),
        (&enlarged(&report, 1e30), "numbers from"),
    ] {
        let reason = PrecisionEstimate::of(scene).to_string();
        assert!(reason.contains(word) && !reason.contains('\n') && reason.len() < 80, "{reason}");
    }
}

// The choice is enough

const WIDTH: u32 = 60;
const HEIGHT: u32 = 45;

/// The PSNR against the model in `f32` and `f64`.
fn agreement(scene: &Scene) -> [f64; 2] {
    let mut scene = scene.clone();
    scene.render.antialiasing = 1;
    let truth = model::render(&scene, WIDTH, HEIGHT);
    [Precision::F32, Precision::F64]
        .map(|precision| image::psnr(&truth, &image::of_scene(&scene, WIDTH, HEIGHT, precision)))
}

/// The PSNR that the chosen precision has to reach. Above 60 dB a single sample decides, here one
/// that meets an edge and may fall to either side: no precision is better than another there.
const ENOUGH: f64 = 50.0;

#[track_caller]
fn assert_enough(what: &str, scene: &Scene) {
    let [narrow, wide] = agreement(scene);
    let precision = chosen(scene);
    let chosen = if precision == Precision::F32 { narrow } else { wide };
    let found = format!("{what}: {precision} of {narrow:.1} dB in f32, {wide:.1} dB in f64");
    assert!(chosen >= ENOUGH, "{found}");
    // `f32` may be a little worse, `f64` not at all.
    assert!(precision == Precision::F32 || wide >= narrow.min(ENOUGH), "{found}");
}

/// Catches a rule that chooses `f32` where it shows, and an `f64` path that is no better.
#[test]
fn the_chosen_precision_is_enough() {
    for name in scenes::NAMES {
        let scene = named(name);
        for scale in [1e-25, 1e-12, 1e-5, 1.0, 1e5, 1e9, 1e12, 1e25] {
            assert_enough(&format!("{name}, {scale:e} times as large"), &enlarged(&scene, scale));
        }
        for offset in [100.0, 500.0, 1e3, 1e4, 1e5, 1e6] {
            assert_enough(
                &format!("{name}, moved by {offset}"),
                &moved(&scene, DVec3::splat(offset)),
            );
        }
    }
    for radius in [100.0, 1e4, 1e6] {
        assert_enough(&format!("on a globe of {radius}"), &on_a_globe(radius));
    }
    for distance in [10.0, 100.0, 1e3, 1e4, 1e5, 1e6] {
        assert_enough(&format!("from {distance} away"), &from_afar(distance));
    }
}

/// Catches a rule that chooses `f64` for nothing: these are wrong in `f32`.
#[test]
fn f64_is_chosen_for_a_reason() {
    let report = named("lab");
    for (what, scene) in [
        ("far", moved(&report, DVec3::splat(1e5))),
        ("on a globe", on_a_globe(1e6)),
        ("from afar", from_afar(1e6)),
        ("vast", enlarged(&report, 1e25)),
        ("minute", enlarged(&report, 1e-25)),
    ] {
        let [narrow, wide] = agreement(&scene);
        assert!(
            narrow < ENOUGH && wide >= ENOUGH,
            "{what}: {narrow:.1} dB in f32, {wide:.1} dB in f64"
        );
    }
}

/// Catches a scene without anything small in it that is minute all the same: squared distances to
/// the light vanish in `f32`.
#[test]
fn a_floor_alone_may_be_minute() {
    let mut scene = named("lab");
    scene.spheres.clear();
    scene.triangles.clear();
    scene.cylinders.clear();
    for scale in [1e-5, 1e-12, 1e-25, 1e5, 1e12, 1e25] {
        assert_enough(&format!("a floor {scale:e} times as large"), &enlarged(&scene, scale));
    }
}

/// Catches a sun whose squared distance overflows in `f32`: the image goes dark.
#[test]
fn a_light_may_be_very_far() {
    for distance in [1e6, 1e18, 1e20, 1e30, 1e100] {
        let mut scene = named("lab");
        scene.lights[0].position = distance * DVec3::new(-0.5, 1.0, 0.7);
        assert_enough(&format!("a light {distance:e} away"), &scene);
    }
}

/// Catches a screen whose size over- or underflows in `f32`: the image is one colour, although
/// only the proportions matter.
#[test]
fn a_screen_may_be_very_small_or_large() {
    for scale in [1e-60, 1e-30, 1e-10, 1e10, 1e30, 1e60] {
        let mut scene = named("lab");
        scene.camera.focal_length *= scale;
        scene.camera.screen_width *= scale;
        assert_enough(&format!("a screen {scale:e} times as large"), &scene);
    }
}
