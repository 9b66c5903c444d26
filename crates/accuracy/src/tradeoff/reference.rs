//! The image that the others are measured against: the limit of the filter, nearly.

use super::setting::{EXACT, Setting};
use crate::metrics::rmse;
use rayweave_contract::{Image, Work};
use rayweave_core::{Sampling, Scene};

/// The truth, and how true it is.
#[derive(Clone, Debug)]
pub struct Reference {
    /// In robust `f64`, some 7,700 rays a pixel.
    pub image: Image,
    /// An estimate of the image's root mean square error: half of the difference between its
    /// halves, each with half of the rays in other places. Errors that the two have in common do
    /// not show.
    pub uncertainty: f64,
}

/// Densities of the two halves, nearly equal: four patterns of samples that have nothing in common.
const HALVES: [[u32; 2]; 2] = [[32, 29], [31, 30]];

impl Reference {
    /// Of `scene` with all its bounces. `render` gives the image of a work.
    ///
    /// # Errors
    ///
    /// Those of `render`, and a scene that is not sound.
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
        let uncertainty = rmse(&first, &second) / 2.0;
        Ok(Self { image: mean(&first, &second), uncertainty })
    }
}

/// Primary rays a pixel in a reference image.
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
