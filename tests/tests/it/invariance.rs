//! An image depends neither on the unit of length nor on the handedness of the axes. Neither change
//! rounds anything, so that not a bit of the image may change.

use rayweave_contract::Image;
use rayweave_core::{Precision, Scene};
use rayweave_tests::image::of_scene;
use rayweave_tests::random_scene::random_scene;
use rayweave_tests::scenes::{self, PRECISIONS};
use rayweave_tests::transform::{enlarged, mirrored};

const WIDTH: u32 = 33;
const HEIGHT: u32 = 24;

fn all() -> impl Iterator<Item = (String, Scene, Precision)> {
    let named = scenes::NAMES.map(|name| (name.to_owned(), scenes::named(name)));
    let random = (0..30).map(|seed| (format!("random {seed}"), random_scene(seed)));
    named.into_iter().chain(random).flat_map(|(name, scene)| {
        PRECISIONS.map(|precision| (name.clone(), scene.clone(), precision))
    })
}

/// Catches every length that does not follow the scene's scale: an offset of 1e-3 from a surface,
/// an epsilon, a limit on `t`; in shadows and mirrors as in the closest hit.
#[test]
fn the_unit_of_length_does_not_matter() {
    for (name, mut scene, precision) in all() {
        scene.render.antialiasing = scene.render.antialiasing.min(2);
        let right = of_scene(&scene, WIDTH, HEIGHT, precision);
        for exponent in [-16, -3, 1, 18] {
            let found = of_scene(&enlarged(&scene, 2f64.powi(exponent)), WIDTH, HEIGHT, precision);
            assert_eq!(found, right, "{name} in {precision}, 2^{exponent} times as large");
        }
    }
}

/// Catches an axis mixed up with another and a sign that is wrong, from the camera to the colour:
/// the mirrored scene's image is the mirror image.
#[test]
fn a_mirrored_scene_is_a_mirrored_image() {
    for (name, mut scene, precision) in all() {
        // The filter adds its samples from the left, which rounds differently from the right.
        scene.render.antialiasing = 0;
        let right = flipped(&of_scene(&scene, WIDTH, HEIGHT, precision));
        let mirrored = [mirrored::<0>(&scene), mirrored::<1>(&scene), mirrored::<2>(&scene)];
        for (axis, scene) in ["x", "y", "z"].iter().zip(&mirrored) {
            let found = of_scene(scene, WIDTH, HEIGHT, precision);
            assert_eq!(found, right, "{name} in {precision}, {axis}");
        }
    }
}

/// Exchanges left and right.
fn flipped(image: &Image) -> Image {
    let mut flipped = image.clone();
    let width = image.width() as usize;
    flipped.pixels_mut().chunks_mut(width).for_each(<[_]>::reverse);
    flipped
}
