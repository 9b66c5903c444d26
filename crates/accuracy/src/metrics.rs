//! Measures of the difference between two images: RMSE, PSNR, FLIP and others.
//!
//! Channels are first clamped to 0..=1, in linear light, as in an 8-bit file. Values beyond that
//! range do not count.

use crate::flip;
use rayweave_contract::Image;

/// The difference of an image from the truth. A channel that is NaN is off by 1, the maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageDifference {
    /// The root mean square error over all channels.
    pub rmse: f64,
    /// The largest error of a channel.
    pub max: f64,
    /// The share of pixels, 0..=1, with a channel that is off by more than 1/255.
    pub share_off: f64,
    /// The mean of FLIP over all pixels, 0..=1: see [`crate::flip`].
    pub flip: f64,
}

impl ImageDifference {
    /// Compares an image with the truth.
    ///
    /// # Panics
    ///
    /// If the images differ in size.
    #[must_use]
    pub fn between(truth: &Image, found: &Image) -> Self {
        let size = |image: &Image| (image.width(), image.height());
        assert_eq!(size(truth), size(found), "the images differ in size");
        let pairs = || truth.pixels().iter().zip(found.pixels());
        let off = |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).any(|c| error(a[c], b[c]) > 1.0 / 255.0);
        Self {
            rmse: rmse(truth.pixels(), found),
            max: errors(truth.pixels(), found).fold(0.0, f64::max),
            share_off: pairs().filter(off).count() as f64 / truth.pixels().len() as f64,
            flip: flip::mean(&flip::map(truth, found)),
        }
    }

    /// Returns the peak signal-to-noise ratio in dB for a peak of 1: infinite for equal images.
    #[must_use]
    pub fn psnr(&self) -> f64 {
        psnr(self.rmse)
    }
}

/// Returns the root mean square error over all channels, as in [`ImageDifference::rmse`]. The
/// pixels of the truth are `f32` or `f64`, row by row.
///
/// # Panics
///
/// If the two differ in their number of pixels.
#[must_use]
pub fn rmse<T: Copy + Into<f64>>(truth: &[[T; 3]], found: &Image) -> f64 {
    let squares: f64 = errors(truth, found).map(|error| error * error).sum();
    (squares / (3.0 * truth.len() as f64)).sqrt()
}

/// Returns the error of each channel.
fn errors<T: Copy + Into<f64>>(truth: &[[T; 3]], found: &Image) -> impl Iterator<Item = f64> {
    assert_eq!(truth.len(), found.pixels().len(), "the images differ in size");
    let (truth, found) = (truth.as_flattened(), found.pixels().as_flattened());
    truth.iter().zip(found).map(|(&a, &b)| error(a, b))
}

/// Returns the peak signal-to-noise ratio in dB that corresponds to a root mean square error, for a
/// peak of 1.
#[must_use]
pub fn psnr(rmse: f64) -> f64 {
    -20.0 * rmse.log10()
}

fn error(truth: impl Into<f64>, found: f32) -> f64 {
    let error = (truth.into().clamp(0.0, 1.0) - f64::from(found).clamp(0.0, 1.0)).abs();
    if error.is_nan() { 1.0 } else { error }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pixels: [[f32; 3]; 2]) -> Image {
        let mut image = Image::new(2, 1).expect("two pixels");
        image.pixels_mut().copy_from_slice(&pixels);
        image
    }

    fn between(truth: [[f32; 3]; 2], found: [[f32; 3]; 2]) -> ImageDifference {
        ImageDifference::between(&image(truth), &image(found))
    }

    const GREY: [f32; 3] = [0.5, 0.25, 1.0];

    #[test]
    fn equal_images() {
        let difference = between([GREY, [0.0; 3]], [GREY, [0.0; 3]]);
        assert_eq!(difference, ImageDifference { rmse: 0.0, max: 0.0, share_off: 0.0, flip: 0.0 });
        assert_eq!(difference.psnr(), f64::INFINITY);
    }

    /// Catches a mean over pixels instead of channels, and a wrong maximum or share.
    #[test]
    fn a_known_error() {
        // One channel of six off by 1/2: the mean square is 1/24.
        let difference = between([[0.0; 3]; 2], [[0.5, 0.0, 0.0], [0.0; 3]]);
        assert!((difference.psnr() - 10.0 * 24f64.log10()).abs() < 1e-12);
        assert_eq!((difference.max, difference.share_off), (0.5, 0.5));
        assert!(difference.flip > 0.1);
    }

    /// Catches a truth that is rounded to f32.
    #[test]
    fn the_truth_may_have_more_digits() {
        let below_one = 1.0 - f64::from(2.0_f32.powi(-30));
        assert_eq!(rmse(&[[below_one; 3]; 2], &image([[1.0; 3]; 2])), 1.0 - below_one);
    }

    #[test]
    fn one_step_of_a_byte_is_not_off() {
        let step = |steps: f32| [steps / 255.0, 0.0, 0.0];
        assert_eq!(between([step(0.0); 2], [step(0.99), step(1.01)]).share_off, 0.5);
    }

    #[test]
    fn values_beyond_the_range_do_not_count() {
        let difference =
            between([[1.5, -2.0, 1.0], [1.0; 3]], [[7.0, -1.0, 1.0], [f32::INFINITY; 3]]);
        assert_eq!((difference.rmse, difference.flip), (0.0, 0.0));
    }

    /// Catches a NaN that counts as black, or that makes the whole figure NaN.
    #[test]
    fn nan_is_the_largest_error() {
        let difference = between([[0.0; 3]; 2], [[f32::NAN, 0.0, 0.0], [0.0; 3]]);
        assert_eq!((difference.max, difference.share_off), (1.0, 0.5));
        assert!((difference.rmse - (1.0 / 6.0_f64).sqrt()).abs() < 1e-12);
    }
}
