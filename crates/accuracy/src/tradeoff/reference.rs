//! The reference image, close to the limit of the filter, against which errors are measured.

use super::setting::{EXACT, Setting};
use crate::metrics::rmse;
use rayweave_contract::{Image, Work};
use rayweave_core::{Sampling, Scene};

/// A reference image and an estimate of its error.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The image, in robust `f64` with some 7,700 rays per pixel.
    pub image: Image,
    /// An estimate of the root mean square error of the image: half of the difference between its
    /// two halves, which have half of the rays each, in different places. Errors common to both do
    /// not show.
    pub uncertainty: f64,
}

/// The densities of the two halves: four nearly equal ones, whose sample patterns share nothing.
const HALVES: [[u32; 2]; 2] = [[32, 29], [31, 30]];

impl Reference {
    /// Renders the reference of `scene` with all its bounces. `render` turns a work into an image.
    ///
    /// # Errors
    ///
    /// Errors of `render`, and an invalid scene.
    pub fn new(
        scene: &Scene,
        size: (u32, u32),
        mut render: impl FnMut(&dyn Work) -> Result<Image, String>,
    ) -> Result<Self, String> {
        let mut image = |density| {
            let setting = setting(density, scene.render.max_reflections);
            render(&*setting.work(scene, size).map_err(|e| e.to_string())?)
        };
        let mut half = |[a, b]: [u32; 2]| Ok::<Image, String>(mean(&image(a)?, &image(b)?));
        let (first, second) = (half(HALVES[0])?, half(HALVES[1])?);
        let uncertainty = rmse(first.pixels(), &second) / 2.0;
        Ok(Self { image: mean(&first, &second), uncertainty })
    }
}

/// Returns the number of primary rays per pixel in a reference image.
#[must_use]
pub fn reference_rays_per_pixel() -> u32 {
    HALVES.as_flattened().iter().map(|&density| setting(density, 0).rays_per_pixel()).sum()
}

fn setting(antialiasing: u32, max_reflections: u32) -> Setting {
    Setting {
        arithmetic: EXACT,
        sampling: Sampling::Importance,
        adaptive: false,
        antialiasing,
        max_reflections,
    }
}

fn mean(a: &Image, b: &Image) -> Image {
    let mut mean = a.clone();
    let channels = mean.pixels_mut().as_flattened_mut().iter_mut();
    for (channel, other) in channels.zip(b.pixels().as_flattened()) {
        *channel = f32::midpoint(*channel, *other);
    }
    mean
}
