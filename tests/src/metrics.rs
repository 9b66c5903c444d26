//! How far an image is from the truth, as one would see it: both are clamped to 0..=1 first, in
//! linear light, as an 8-bit file would do. What a channel has above 1 or below 0 does not count.

use rayweave_contract::Image;

/// Peak signal-to-noise ratio in dB over all channels, for a peak of 1: infinite for equal
/// images, NaN if a channel is.
///
/// # Panics
///
/// If the two have different numbers of pixels.
#[must_use]
pub fn psnr(truth: &[[f64; 3]], image: &Image) -> f64 {
    let errors = errors(truth, image);
    let squares: f64 = errors.as_flattened().iter().map(|error| error * error).sum();
    -10.0 * (squares / errors.as_flattened().len() as f64).log10()
}

/// The share of pixels, 0..=1, with a channel that is off by more than 1/255, or is NaN.
///
/// # Panics
///
/// If the two have different numbers of pixels.
#[must_use]
pub fn share_off(truth: &[[f64; 3]], image: &Image) -> f64 {
    let errors = errors(truth, image);
    let off = |pixel: &&[f64; 3]| pixel.iter().any(|&error| error.is_nan() || error > 1.0 / 255.0);
    errors.iter().filter(off).count() as f64 / errors.len() as f64
}

/// The largest error of a channel; NaN if a channel is.
///
/// # Panics
///
/// If the two have different numbers of pixels.
#[must_use]
pub fn worst(truth: &[[f64; 3]], image: &Image) -> f64 {
    let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
    errors(truth, image).as_flattened().iter().copied().fold(0.0, larger)
}

fn errors(truth: &[[f64; 3]], image: &Image) -> Vec<[f64; 3]> {
    assert_eq!(truth.len(), image.pixels().len(), "the images differ in size");
    let error = |c: usize, right: &[f64; 3], found: &[f32; 3]| {
        (right[c].clamp(0.0, 1.0) - f64::from(found[c]).clamp(0.0, 1.0)).abs()
    };
    truth.iter().zip(image.pixels()).map(|(t, p)| [0, 1, 2].map(|c| error(c, t, p))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pixels: [[f32; 3]; 2]) -> Image {
        let mut image = Image::new(2, 1).expect("two pixels");
        image.pixels_mut().copy_from_slice(&pixels);
        image
    }

    #[test]
    fn equal_images() {
        let image = image([[0.5, 0.25, 1.0], [0.0; 3]]);
        let truth = [[0.5, 0.25, 1.0], [0.0; 3]];
        assert_eq!(psnr(&truth, &image), f64::INFINITY);
        assert_eq!(share_off(&truth, &image), 0.0);
        assert_eq!(worst(&truth, &image), 0.0);
    }

    #[test]
    fn a_known_error() {
        // One channel of six off by 1/2: the mean square is 1/24.
        let image = image([[0.5, 0.0, 0.0], [0.0; 3]]);
        let truth = [[0.0; 3]; 2];
        assert!((psnr(&truth, &image) - 10.0 * 24f64.log10()).abs() < 1e-12);
        assert_eq!(share_off(&truth, &image), 0.5);
        assert_eq!(worst(&truth, &image), 0.5);
    }

    #[test]
    fn one_step_of_a_byte_is_not_off() {
        let image = image([[0.0; 3], [0.25; 3]]);
        assert_eq!(share_off(&[[1.0 / 255.0; 3], [0.25 + 1.01 / 255.0; 3]], &image), 0.5);
    }

    #[test]
    fn what_is_beyond_the_range_does_not_count() {
        let image = image([[7.0, -1.0, 1.0], [f32::INFINITY; 3]]);
        assert_eq!(psnr(&[[1.5, -2.0, 1.0], [1.0; 3]], &image), f64::INFINITY);
    }

    #[test]
    fn nan_counts() {
        let image = image([[f32::NAN, 0.0, 0.0], [0.0; 3]]);
        let truth = [[0.0; 3]; 2];
        assert!(psnr(&truth, &image).is_nan());
        assert!(worst(&truth, &image).is_nan());
        assert_eq!(share_off(&truth, &image), 0.5);
    }
}
