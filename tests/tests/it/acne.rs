//! Nothing shadows or mirrors itself by rounding: rays that leave a convex surface do not meet it
//! again, at any scale and far from the origin.

use glam::{DVec3, dvec3 as v};
use rayweave_core::Precision;
use rayweave_core::scene::{Material, Scene};
use rayweave_tests::image;
use rayweave_tests::model::{self, Primitive};
use rayweave_tests::scenes::{PRECISIONS, cylinder, light, looking, plane, sphere, triangle, with};
use rayweave_tests::transform::{enlarged, moved, rounded};

const WIDTH: u32 = 48;
const HEIGHT: u32 = 36;

/// A red primitive about 1 large at the origin, before a blue background.
fn scene(eye: DVec3, primitive: Primitive) -> Scene {
    let mut scene = with(looking(eye, DVec3::ZERO, &[]), [primitive]);
    scene.camera.screen_width = 0.8;
    scene.render.background = DVec3::Z;
    scene.render.max_reflections = 1;
    scene.materials[0] =
        Material { ambient: 0.0, diffuse: 1.0, specular: 0.0, ..Material::new(DVec3::X) };
    scene
}

/// Scenes of one primitive, each convex as the camera sees it: it sees no end of the cylinder, and
/// so no inside.
fn convex() -> [(&'static str, Scene); 6] {
    let eye = v(3.1, 1.7, 2.3);
    let plane = plane(DVec3::ZERO, v(0.3, 1.0, -0.2));
    let [a, b, c] = [v(-1.3, -0.4, 0.7), v(1.1, -0.6, 0.4), v(0.2, 1.2, -0.5)];
    [
        ("sphere", scene(eye, sphere(DVec3::ZERO, 1.0))),
        ("plane", scene(eye, plane)),
        ("plane from below", scene(eye * v(1.0, -1.0, 1.0), plane)),
        ("triangle", scene(eye, triangle([a, b, c]))),
        ("triangle the other way round", scene(eye, triangle([a, c, b]))),
        ("cylinder", scene(eye, cylinder(-20.0 * DVec3::Y, 40.0, 0.7))),
    ]
}

/// Lists every scene, changed in this way, at every scale and place, in both precisions. The
/// farthest place is at a ratio of 3000, near the largest at which `f32` is chosen.
fn everywhere(change: impl Fn(&mut Scene)) -> Vec<(String, Scene, Precision)> {
    let offsets =
        [DVec3::ZERO, v(10.3, -7.1, 5.9), v(130.7, 210.3, -170.9), v(-1700.3, 2100.7, 1300.1)];
    let places: Vec<_> = [1e-3, 0.037, 1.0, 17.3, 1e3]
        .into_iter()
        .flat_map(|scale| offsets.map(|offset| (scale, offset)))
        .collect();
    let mut all = Vec::new();
    for (name, mut scene) in convex() {
        change(&mut scene);
        for &(scale, offset) in &places {
            // Numbers that `f32` holds, so that the model sees the very same surface.
            let placed = rounded(&enlarged(&moved(&scene, offset), scale));
            all.extend(PRECISIONS.map(|precision| {
                let name = format!("{name}, {scale} large, moved by {offset}, in {precision}");
                (name, placed.clone(), precision)
            }));
        }
    }
    all
}

/// Catches a start of shadow rays that is on or below the surface, for lights high and low; and
/// one so far above it that it passes the terminator.
#[test]
fn the_tracer_lights_what_the_model_lights() {
    for lamp in [v(2.0, 9.0, 4.0), v(40.0, 6.0, -3.0), v(-5.0, 3.0, 9.0), v(7.0, 0.5, 0.3)] {
        let mut compared = 0;
        for (name, scene, precision) in everywhere(|scene| scene.lights.push(light(lamp))) {
            let truth = model::render(&scene, WIDTH, HEIGHT);
            let image = image::of_scene(&scene, WIDTH, HEIGHT, precision);
            let mut outline = 0;
            for (index, (right, found)) in truth.iter().zip(image.pixels()).enumerate() {
                // At the outline rounding may choose between surface and background.
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
                    "{name}: {found:?} at {place:?}, not {right:?}; light at {lamp}"
                );
            }
            assert!(
                outline <= 3,
                "{name}: {outline} pixels of the outline differ; light at {lamp}"
            );
        }
        assert!(compared > 100_000, "only {compared} pixels show a surface");
    }
}

/// Catches a mirrored ray that meets the mirror it comes from. Before a white background a full
/// mirror is white, as is the background itself; a ray that is mirrored twice is black.
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
