//! FLIP, a measure of the difference that a person sees when flipping between two images, computed
//! by its authors' own program (Andersson, Nilsson, Akenine-Moller et al., "FLIP: A Difference
//! Evaluator for Alternating Images", 2020).

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageFloat, FlipImageRgb8, magma_lut};
use rayweave_contract::Image;

/// Returns the difference of each pixel, from 0 (invisible) to 1, at the viewing distance that the
/// authors suggest. The images are compared as they look in an 8-bit file, shown as sRGB.
pub(crate) fn map(truth: &Image, found: &Image) -> FlipImageFloat {
    nv_flip::flip(shown(truth), shown(found), DEFAULT_PIXELS_PER_DEGREE)
}

/// Returns the mean over all pixels.
pub(crate) fn mean(map: &FlipImageFloat) -> f64 {
    let pixels = map.to_vec();
    pixels.iter().copied().map(f64::from).sum::<f64>() / pixels.len() as f64
}

/// Returns the difference as an image: black where there is none, then violet and orange to white.
///
/// # Panics
///
/// If the images differ in size.
#[must_use]
pub fn difference_image(truth: &Image, found: &Image) -> Image {
    let colors = map(truth, found).apply_color_lut(&magma_lut()).to_vec();
    let mut image = truth.clone();
    for (pixel, color) in image.pixels_mut().iter_mut().zip(colors.chunks_exact(3)) {
        *pixel = [0, 1, 2].map(|c| f32::from(color[c]) / 255.0);
    }
    image
}

fn shown(image: &Image) -> FlipImageRgb8 {
    FlipImageRgb8::with_data(image.width(), image.height(), &image.to_rgb8())
}
