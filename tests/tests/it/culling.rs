//! Culling by planes, cones and bounding spheres changes no image. In scenes of a few primitives
//! acceleration gives the same bits as brute force, also where eyes and lights stand in planes, on
//! surfaces and inside of primitives, and where rays run along them.

use glam::{DVec3, dvec3 as v};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_core::scene::{Camera, Light, Material, RenderSettings};
use rayweave_core::{Execution, Scene};
use rayweave_tests::image::{accelerated, difference, difference_from_plain, in_tiles};
use rayweave_tests::model::Primitive;
use rayweave_tests::scenes::{self, PRECISIONS, plane, with};
use rayweave_tests::transform::{enlarged, moved};

const SIZE: (u32, u32) = (12, 9);

/// Compares acceleration, in packets of every width, with trying everything.
fn acceleration_differs(scene: &Scene) -> Option<String> {
    PRECISIONS.into_iter().find_map(|precision| {
        difference_from_plain(&scene.with_arithmetic(precision), SIZE, accelerated())
    })
}

// Scenes that are hard in one way

fn light(position: DVec3) -> Light {
    Light { power: 0.7, ..scenes::light(position) }
}

fn sphere(center: DVec3, radius: f64) -> Primitive {
    scenes::sphere(center, radius).of(1)
}

fn triangle(vertices: [DVec3; 3]) -> Primitive {
    scenes::triangle(vertices).of(2)
}

fn cylinder(bottom: DVec3, height: f64, radius: f64) -> Primitive {
    scenes::cylinder(bottom, height, radius).of(3)
}

fn camera(position: DVec3, look_at: DVec3) -> Camera {
    let up = if position.x == look_at.x && position.z == look_at.z { DVec3::X } else { DVec3::Y };
    Camera { position, look_at, up, focal_length: 1.0, screen_width: 1.5 }
}

/// A scene without primitives; material 1 is a mirror.
fn bare() -> Scene {
    let material =
        |color, reflection| Material { specular: 0.5, reflection, ..Material::new(color) };
    Scene {
        camera: camera(v(0.5, 1.0, -5.0), v(0.0, 0.5, 0.0)),
        render: RenderSettings {
            background: v(0.1, 0.2, 0.3),
            max_reflections: 2,
            antialiasing: 0,
            ..RenderSettings::default()
        },
        lights: vec![light(v(3.0, 5.0, -2.0))],
        materials: vec![
            material(v(0.9, 0.8, 0.7), 0.25),
            material(v(0.2, 0.9, 0.4), 0.6),
            material(v(0.3, 0.4, 1.0), 0.0),
            material(v(1.0, 0.5, 0.1), 0.0),
        ],
        ..scenes::empty()
    }
}

/// A scene of a sphere, a triangle and a cylinder.
fn bounded() -> Scene {
    let corners = [v(0.0, -1.0, 1.0), v(2.0, -1.0, 0.0), v(1.0, 2.0, 1.0)];
    let sphere = sphere(v(-1.0, 0.0, 1.0), 1.0);
    with(bare(), [sphere, triangle(corners), cylinder(v(-2.0, -1.0, -1.0), 1.5, 0.5)])
}

/// The same on a floor.
fn scene() -> Scene {
    with(bounded(), [plane(v(0.0, -1.0, 0.0), DVec3::Y)])
}

/// A scene, and the same moved and enlarged so that its numbers are no longer whole.
fn placed(scene: &Scene) -> [Scene; 4] {
    [
        scene.clone(),
        moved(scene, v(0.1, -0.3, 0.7)),
        enlarged(&moved(scene, v(1000.1, -700.3, 300.7)), 0.3),
        moved(&enlarged(scene, 1e-3), v(0.7, 0.1, -0.3)),
    ]
}

#[track_caller]
fn assert_agrees_everywhere(scene: &Scene, name: &str) {
    for (i, scene) in placed(scene).iter().enumerate() {
        assert_eq!(acceleration_differs(scene), None, "{name}, place {i}");
    }
}

/// Catches a side that rounding assigns to an eye or a light in the plane itself: with the eye
/// there, nothing is on either side; a light there lights nothing of the plane, and the plane
/// hides it.
#[test]
fn eye_and_light_in_a_plane() {
    let tilted = v(0.3, 1.0, -0.2);
    for normal in [DVec3::Y, -DVec3::Y, tilted, -tilted, v(1.0, 1.0, 1.0), v(1e-9, 1.0, 0.0)] {
        let eye = bare().camera.position;
        let mut scene = with(scene(), [plane(eye, normal)]);
        assert_agrees_everywhere(&scene, &format!("eye in the plane, {normal}"));
        let mut along = scene.clone();
        let aside = normal.any_orthogonal_vector();
        along.camera.look_at = eye + aside;
        along.camera.up = normal;
        assert_agrees_everywhere(&along, &format!("eye in the plane and along it, {normal}"));
        scene.lights.push(light(eye + aside));
        assert_agrees_everywhere(&scene, &format!("both in the plane, {normal}"));

        let lamp = v(1.0, 2.5, -1.0);
        let mut scene = with(self::scene(), [plane(lamp + 3.0 * aside, normal)]);
        scene.lights.push(light(lamp));
        assert_agrees_everywhere(&scene, &format!("light in the plane, {normal}"));
    }
}

/// Catches a light that is left out though it lights something, or a light behind a plane that
/// lights something before it: such a light changes no image.
#[test]
fn a_light_behind_a_plane_lights_nothing() {
    for (point, normal) in [
        (v(0.0, -1.0, 0.0), DVec3::Y),
        (v(0.0, -1.0, 0.0), -DVec3::Y),
        (v(0.0, 0.0, 4.0), v(0.1, 0.2, 1.0)),
        (v(4.0, 0.0, 0.0), v(-1.0, 0.3, 0.0)),
    ] {
        let without = with(bounded(), [plane(point, normal)]);
        for distance in [1e-3, 1.0, 100.0] {
            let eye = without.camera.position;
            let height = (eye - point).dot(normal.normalize());
            let behind = point - distance * height.signum() * normal.normalize();
            let mut with = without.clone();
            with.lights.insert(0, light(behind));
            assert_agrees_everywhere(&with, &format!("{distance} behind {normal}"));
            if distance < 1.0 {
                // At the third place this is within the rounding of `f32`: the light may stand in
                // the plane.
                continue;
            }
            for (with, without) in placed(&with).iter().zip(placed(&without)) {
                for precision in PRECISIONS {
                    let [found, right] = [with, &without].map(|scene| {
                        let scene = scene.with_arithmetic(precision);
                        in_tiles(&scene, SIZE, Execution::default(), 1000)
                    });
                    let name = format!("{distance} behind {normal}, {precision}");
                    assert_eq!(difference(&found, &right), None, "{name}");
                }
            }
        }
    }
}

/// Catches a cone around a primitive that has no outside: eyes and lights in it, on it, at its
/// middle.
#[test]
fn eye_and_light_in_and_on_primitives() {
    let scene = scene();
    let [a, b, c] = scene.triangles[0].vertices;
    let (sphere, cylinder) = (scene.spheres[0], scene.cylinders[0]);
    let axis = (cylinder.bottom + cylinder.top) / 2.0;
    for place in [
        sphere.center,
        sphere.center + v(0.25, 0.5, 0.0),
        sphere.center + v(0.6, 0.8, 0.0),
        sphere.center + v(0.0, 1.0, 0.0),
        sphere.center + v(0.0, 1.0 + 1e-7, 0.0),
        a,
        (a + b) / 2.0,
        (a + b + c) / 3.0,
        // In the triangle's plane.
        a + 2.0 * (b - a) + (c - a),
        axis,
        axis + v(0.3, 0.0, 0.4),
        cylinder.top,
        cylinder.top + DVec3::Y,
    ] {
        let mut lit = scene.clone();
        lit.lights.push(light(place));
        assert_agrees_everywhere(&lit, &format!("light at {place}"));
        for target in [DVec3::ZERO, sphere.center, axis, place - DVec3::Y, place + DVec3::X] {
            if target != place {
                let seen = Scene { camera: camera(place, target), ..scene.clone() };
                assert_agrees_everywhere(&seen, &format!("eye at {place} looks at {target}"));
            }
        }
    }
}

/// Catches a point that is taken to be on the eye's side of a plane though a primitive cuts the
/// plane there: no ray sees the other side.
#[test]
fn primitives_that_cut_planes() {
    for normal in [DVec3::Y, v(0.3, 1.0, -0.2), DVec3::Z] {
        for distance in [-1.0, -0.5, 0.0, 0.25, 1.0] {
            let mut scene = scene();
            scene.lights.extend([light(v(-3.0, -6.0, 1.0)), light(v(0.0, 2.0, 7.0))]);
            let away = distance * normal.normalize();
            for (what, point) in [
                ("sphere", scene.spheres[0].center + away),
                ("triangle", scene.triangles[0].vertices[2] - away),
                ("cylinder", scene.cylinders[0].bottom - away),
            ] {
                let cut = with(scene.clone(), [plane(point, normal)]);
                assert_agrees_everywhere(&cut, &format!("a {what}, {normal}, {distance}"));
            }
        }
    }
}

/// Catches planes that are told apart by pairs: a wedge, a room and two that are one.
#[test]
fn planes_that_cut_each_other() {
    let wedge = vec![plane(DVec3::ZERO, v(1.0, 1.0, 0.0)), plane(DVec3::ZERO, v(-1.0, 1.0, 0.0))];
    let walls = [DVec3::X, DVec3::Y, DVec3::Z].map(|normal| [normal, -normal]);
    let room = walls.as_flattened().iter().map(|&n| plane(-6.0 * n, n)).collect();
    let twice = vec![plane(-DVec3::Y, DVec3::Y), plane(-DVec3::Y, -3.0 * DVec3::Y)];
    let crossing =
        vec![plane(DVec3::ZERO, v(0.1, 1.0, 0.0)), plane(DVec3::ZERO, v(-0.1, 1.0, 0.0))];
    for (name, planes) in
        [("wedge", wedge), ("room", room), ("twice", twice), ("crossing", crossing)]
    {
        for eye in [v(0.0, 1.0, -5.0), v(-5.0, 1.0, -1.0), v(1.0, -5.0, 0.5), v(0.25, 0.5, -3.0)] {
            let mut scene = with(bounded(), planes.clone());
            scene.camera = camera(eye, v(0.0, 0.5, 0.0));
            let corners =
                [v(0.0, 5.0, 0.0), v(5.0, 0.5, -1.0), v(-5.0, 0.0, 1.0), v(0.5, -5.0, 0.0)];
            scene.lights = corners.map(light).into();
            assert_agrees_everywhere(&scene, &format!("{name} from {eye}"));
        }
    }
}

/// Catches a cone that is too narrow for a far ray: a small primitive next to a light throws a
/// shadow far away, where the rays to the light begin with large numbers.
#[test]
fn small_primitives_next_to_a_light() {
    for far in [10.0, 300.0, 1e4, 1e5] {
        for (distance, radius) in [(0.01, 1e-3), (0.1, 1e-3), (0.1, 0.01), (1.0, 1e-4)] {
            let toward = v(0.3, -0.2, 1.0).normalize();
            let center = distance * toward;
            let corners = [v(1.0, 0.0, 0.0), v(-0.5, 0.8, 0.1), v(-0.5, -0.8, -0.1)];
            let all = [
                sphere(center, radius),
                triangle(corners.map(|c| center + radius * c)),
                cylinder(center - radius * DVec3::Y, 2.0 * radius, radius),
            ];
            for (i, small) in all.into_iter().enumerate() {
                let mut scene = with(bare(), [plane(far * toward, toward), small]);
                scene.lights = vec![light(DVec3::ZERO)];
                // The whole shadow, from the side, and its edge.
                let edge = far * (center + v(radius, 0.0, 0.0)).normalize();
                scene.camera = camera(v(-0.2 * far, 0.1 * far, 0.0), edge);
                for share in [3.0, 0.1] {
                    scene.camera.screen_width = share * radius / distance;
                    let name = format!("primitive {i}, {distance} away, {radius} large, at {far}");
                    assert_agrees_everywhere(&scene, &name);
                }
            }
        }
    }
}

/// Catches a lane that takes a NaN or an infinity another way than a single ray does: rays along an
/// axis, along a cylinder's axis and wall, in a triangle's plane, in a plane, and through corners.
#[test]
fn rays_along_primitives() {
    for (from, to) in [
        (v(-2.0, 5.0, -1.0), v(-2.0, 0.0, -1.0)),
        (v(-2.0, -5.0, -1.0), v(-2.0, 0.0, -1.0)),
        (v(-1.5, 5.0, -1.0), v(-1.5, 0.0, -1.0)),
        (v(-1.0, 0.0, -5.0), v(-1.0, 0.0, 0.0)),
        (v(0.0, -1.0, -5.0), v(0.0, -1.0, 0.0)),
        (v(5.0, 2.0, 1.0), v(0.0, 2.0, 1.0)),
        (v(-5.0, -1.0, 1.0), v(0.0, -1.0, 1.0)),
        (v(0.0, 1.0, -1.0), v(0.0, 1.0, 0.0)),
        (v(0.0, 5.0, 0.0), v(0.0, 0.0, 0.0)),
    ] {
        for thin in [1.5, 1e-3, 1e-20] {
            // Two triangles, upright and lying, as the axes are.
            let upright = [v(-2.0, 0.0, -1.0), v(0.0, 0.0, -1.0), v(-2.0, 3.0, -1.0)];
            let lying = [v(-3.0, 1.0, -3.0), v(3.0, 1.0, -3.0), v(0.0, 1.0, 3.0)];
            let across = plane(v(0.0, 0.0, 1.0), DVec3::Z);
            let mut scene = with(scene(), [across, triangle(upright), triangle(lying)]);
            scene.camera = camera(from, to);
            // All rays of an image this narrow are parallel.
            scene.camera.screen_width = thin;
            assert_agrees_everywhere(&scene, &format!("from {from} to {to}, {thin} wide"));
            // The boxes of a BVH as well.
            let scene = with(scene, (0..12).map(|i| sphere(v(-1.0, 0.0, f64::from(i)), 1.0)));
            assert_agrees_everywhere(&scene, &format!("a BVH, from {from} to {to}, {thin} wide"));
        }
    }
}

/// Catches cones around another point than the eye's image: small primitives far away, seen in
/// floors and tilted mirrors near the eye and far from it, and mirrors whose normal is so long or
/// short that its square is no number.
#[test]
fn small_primitives_in_mirrors() {
    for (i, (point, normal)) in [
        (v(0.0, -1.0, 0.0), DVec3::Y),
        (v(0.0, -1.0, 40.0), v(0.3, 1.0, -0.9)),
        (v(0.5, 1.0, -4.9), v(0.1, 0.8, -0.7)),
        (v(-3.0, 0.0, 9.0), v(1.0, 0.2, -1.0)),
    ]
    .into_iter()
    .enumerate()
    {
        let small = (0..6).map(f64::from).flat_map(|along| {
            let corner = v(along - 3.0, 1.0, 3.0 - 5.0 * along);
            [
                sphere(v(along - 2.0, 0.4 * along, -2.0 - 3.0 * along), 0.05 + 0.2 * along),
                triangle([corner, v(along - 2.6, corner.y, corner.z), v(corner.x, 1.7, corner.z)]),
                cylinder(v(along, 0.2, -3.0 - 4.0 * along), 0.3, 0.1),
            ]
        });
        let scene = with(bounded(), small);
        for length in [1.0, 1e200, 1e-158, 1e-200] {
            let scene = with(scene.clone(), [plane(point, normal * length)]);
            assert_agrees_everywhere(&scene, &format!("mirror {i}, its normal {length:e} long"));
        }
    }
}

// Scenes of whole numbers

/// Few values, so that primitives meet, touch and lie in each other's planes.
fn place() -> impl Strategy<Value = DVec3> {
    let coordinate = || (-6..=6i32).prop_map(|k| f64::from(k) / 2.0);
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

fn normal() -> impl Strategy<Value = DVec3> {
    let axis = (0..3usize, any::<bool>()).prop_map(|(axis, back)| {
        let mut normal = DVec3::ZERO;
        normal[axis] = if back { -1.0 } else { 1.0 };
        normal
    });
    prop_oneof![axis, place().prop_filter("not zero", |v| *v != DVec3::ZERO)]
}

fn on_the_grid() -> impl Strategy<Value = Scene> {
    let size = || (1..=6u32).prop_map(|k| f64::from(k) / 2.0);
    let planes = vec((place(), normal(), 0..4usize).prop_map(|(p, n, m)| plane(p, n).of(m)), 0..4);
    let sphere = (place(), size(), 0..4usize).prop_map(|(c, r, m)| scenes::sphere(c, r).of(m));
    let triangle = ([place(), place(), place()], 0..4usize)
        .prop_map(|(corners, m)| scenes::triangle(corners).of(m));
    let cylinder = (place(), size(), size(), 0..4usize)
        .prop_map(|(bottom, height, r, m)| scenes::cylinder(bottom, height, r).of(m));
    let primitives = (planes, vec(sphere, 0..4), vec(triangle, 0..4), vec(cylinder, 0..3));
    let view = (place(), place(), prop_oneof![Just(1.5), Just(0.3), Just(6.0)]);
    (primitives, vec(place(), 1..4), view).prop_map(
        |((planes, spheres, triangles, cylinders), lights, (eye, target, screen_width))| {
            let scene = Scene {
                camera: Camera { screen_width, ..camera(eye, target) },
                lights: lights.into_iter().map(light).collect(),
                ..bare()
            };
            with(scene, [planes, spheres, triangles, cylinders].concat())
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000,
        rng_seed: RngSeed::Fixed(2028),
        failure_persistence: None,
        max_global_rejects: 100_000,
        ..ProptestConfig::default()
    })]

    /// Catches all of this in scenes drawn by chance.
    #[test]
    fn scenes_on_a_grid(
        mut scene in on_the_grid(),
        placement in 0..4usize,
        mirrors in any::<bool>(),
    ) {
        prop_assume!(scene.check().is_ok());
        if !mirrors {
            // What is behind the eye and the lights is then left out.
            scene.materials.iter_mut().for_each(|material| material.reflection = 0.0);
        }
        let scene = &placed(&scene)[placement];
        prop_assume!(scene.check().is_ok());
        prop_assert_eq!(acceleration_differs(scene), None);
    }
}
