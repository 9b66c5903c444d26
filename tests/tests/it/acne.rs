//! Nothing shadows or mirrors itself by rounding: rays that leave a convex surface do not meet it
//! again, at any scale and far from the origin.

use glam::DVec3;
use rayweave_core::Precision;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Scene, Sphere, Triangle,
};
use rayweave_tests::transform::{enlarged, moved, rounded};
use rayweave_tests::{image, model};

const WIDTH: u32 = 48;
const HEIGHT: u32 = 36;

/// One thing about 1 large at the origin, its material red, before a blue background.
fn scene() -> Scene {
    Scene {
        camera: Camera {
            position: DVec3::new(3.1, 1.7, 2.3),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            focal_length: 1.0,
            screen_width: 0.8,
        },
        render: RenderSettings {
            background: DVec3::Z,
            max_reflections: 1,
            antialiasing: 0,
            ..RenderSettings::default()
        },
        lights: Vec::new(),
        materials: vec![Material {
            ambient: 0.0,
            diffuse: 1.0,
            specular: 0.0,
            ..Material::new(DVec3::X)
        }],
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    }
}

/// Each is convex as the camera sees it: of the cylinder it sees no end, and so no inside.
fn things() -> [(&'static str, Scene); 6] {
    let plane = Plane { point: DVec3::ZERO, normal: DVec3::new(0.3, 1.0, -0.2), material: 0 };
    let corners = [[-1.3, -0.4, 0.7], [1.1, -0.6, 0.4], [0.2, 1.2, -0.5]];
    let triangle = Triangle { vertices: corners.map(DVec3::from_array), material: 0 };
    let [a, b, c] = triangle.vertices;
    let below = DVec3::new(1.0, -1.0, 1.0);
    let seen_from = |sign| Camera { position: sign * scene().camera.position, ..scene().camera };
    let (bottom, top) = (-20.0 * DVec3::Y, 20.0 * DVec3::Y);
    [
        (
            "sphere",
            Scene {
                spheres: vec![Sphere { center: DVec3::ZERO, radius: 1.0, material: 0 }],
                ..scene()
            },
        ),
        ("plane", Scene { planes: vec![plane], ..scene() }),
        ("plane from below", Scene { planes: vec![plane], camera: seen_from(below), ..scene() }),
        ("triangle", Scene { triangles: vec![triangle], ..scene() }),
        (
            "triangle the other way round",
            Scene { triangles: vec![Triangle { vertices: [a, c, b], material: 0 }], ..scene() },
        ),
        (
            "cylinder",
            Scene {
                cylinders: vec![Cylinder { bottom, top, radius: 0.7, material: 0 }],
                ..scene()
            },
        ),
    ]
}

/// Every thing, changed in this way, at every scale and place, in both precisions. The farthest
/// place is at a ratio of 3000, near the largest at which `f32` is chosen.
fn everywhere(change: impl Fn(&mut Scene)) -> Vec<(String, Scene, Precision)> {
    let offsets = [[0.0; 3], [10.3, -7.1, 5.9], [130.7, 210.3, -170.9], [-1700.3, 2100.7, 1300.1]];
    let mut all = Vec::new();
    for (name, mut scene) in things() {
        change(&mut scene);
        for (scale, offset) in [1e-3, 0.037, 1.0, 17.3, 1e3]
            .into_iter()
            .flat_map(|scale| offsets.map(|offset| (scale, offset)))
        {
            let offset = DVec3::from_array(offset);
            // What `f32` has, so that the model sees the very same surface.
            let placed = rounded(&enlarged(&moved(&scene, offset), scale));
            for precision in [Precision::F32, Precision::F64] {
                let name = format!("{name}, {scale} large, moved by {offset}, in {precision}");
                all.push((name, placed.clone(), precision));
            }
        }
    }
    all
}

/// Catches a start of shadow rays that is on or below the surface, for lights high and low; and
/// one so far above it that it passes the terminator.
#[test]
fn what_the_model_lights_is_lit() {
    for light in [[2.0, 9.0, 4.0], [40.0, 6.0, -3.0], [-5.0, 3.0, 9.0], [7.0, 0.5, 0.3]] {
        let light = Light { position: DVec3::from_array(light), color: DVec3::ONE, power: 1.0 };
        let mut compared = 0;
        for (name, scene, precision) in everywhere(|scene| scene.lights.push(light)) {
            let truth = model::render(&scene, WIDTH, HEIGHT);
            let image = image::of_scene(&scene, WIDTH, HEIGHT, precision);
            let mut outline = 0;
            for (index, (right, found)) in truth.iter().zip(image.pixels()).enumerate() {
                // At the outline rounding may choose between the thing and the background.
                if (right[2] == 1.0) != (found[2] == 1.0) {
                    outline += 1;
                    continue;
                }
                compared += u32::from(found[2] == 0.0);
                let place = image.position(index);
                let error = (f64::from(found[0]) - right[0]).abs();
                // Black would be off by as much as the pixel is lit.
                assert!(
                    error < 0.02,
                    "{name}: {found:?} at {place:?}, not {right:?}; light {light:?}"
                );
            }
            assert!(
                outline <= 3,
                "{name}: {outline} pixels show the thing or do not; light {light:?}"
            );
        }
        assert!(compared > 100_000, "only {compared} pixels show a thing");
    }
}

/// Catches a mirrored ray that meets the mirror it comes from. Before white, a full mirror is
/// white and so is what misses it; what is mirrored twice is black.
#[test]
fn a_convex_mirror_does_not_see_itself() {
    let mirror = |scene: &mut Scene| {
        scene.render.background = DVec3::ONE;
        scene.materials[0].reflection = 1.0;
    };
    for (name, scene, precision) in everywhere(mirror) {
        let image = image::of_scene(&scene, WIDTH, HEIGHT, precision);
        let other = image.pixels().iter().filter(|color| **color != [1.0; 3]).count();
        assert_eq!(other, 0, "{name}: pixels that are not white");
    }
}
