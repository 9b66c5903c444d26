//! The settings of the tracer that trade speed for error, and the values that a study tries.

use rayweave_contract::Work;
use rayweave_core::scene::{RenderSettings, SceneError};
use rayweave_core::{Arithmetic, Execution, Formulas, Precision, Sampling, Scene, tracer};
use std::fmt;

/// A value for every setting that trades speed for error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The formulas and the number type.
    pub arithmetic: Arithmetic,
    /// The placement of samples; without effect for one ray per pixel.
    pub sampling: Sampling,
    /// True if lattice points are interpolated where pixels look alike.
    pub adaptive: bool,
    /// The density `s`, as in [`rayweave_core::scene::RenderSettings::antialiasing`].
    pub antialiasing: u32,
    /// The maximum number of mirror bounces after the primary ray.
    pub max_reflections: u32,
}

/// The densities that a study tries: 1 to 289 rays per pixel on the lattice.
pub const DENSITIES: [u32; 7] = [0, 1, 2, 3, 4, 6, 8];

/// The most exact arithmetic, the standard of comparison for the others.
pub const EXACT: Arithmetic = Arithmetic { formulas: Formulas::Robust, precision: Precision::F64 };

/// All arithmetics, the most exact one first.
pub const ARITHMETICS: [Arithmetic; 4] = [
    EXACT,
    Arithmetic { formulas: Formulas::Robust, precision: Precision::F32 },
    Arithmetic { formulas: Formulas::Textbook, precision: Precision::F64 },
    Arithmetic { formulas: Formulas::Textbook, precision: Precision::F32 },
];

impl Setting {
    /// Returns the lab report's own setting: its formulas in `f32`, 5 x 5 rays per pixel, and all
    /// bounces of the scene.
    #[must_use]
    pub fn report(max_reflections: u32) -> Self {
        Self {
            arithmetic: Arithmetic { formulas: Formulas::Textbook, precision: Precision::F32 },
            sampling: Sampling::Lattice,
            adaptive: false,
            antialiasing: 2,
            max_reflections,
        }
    }

    /// Returns every setting that a study tries on `scene`. Settings that differ only in their
    /// arithmetic are adjacent, the most exact one first. Settings with the scene's own depth come
    /// before those with less.
    #[must_use]
    pub fn all(scene: &Scene) -> Vec<Self> {
        let mut all = Vec::new();
        let patterns =
            [(Sampling::Lattice, false), (Sampling::Importance, false), (Sampling::Lattice, true)];
        for (sampling, adaptive) in patterns {
            for antialiasing in DENSITIES {
                // One ray per pixel is the same in all patterns. On a lattice with one step per
                // pixel, all points are centres.
                let same = sampling == Sampling::Importance || adaptive;
                if (antialiasing == 0 && same) || (antialiasing == 1 && adaptive) {
                    continue;
                }
                // The other patterns already show the effect of depth.
                let depths = depths(scene);
                let depths = if adaptive { &depths[..1] } else { &depths[..] };
                for &max_reflections in depths {
                    let setting = |arithmetic| Self {
                        arithmetic,
                        sampling,
                        adaptive,
                        antialiasing,
                        max_reflections,
                    };
                    all.extend(ARITHMETICS.map(setting));
                }
            }
        }
        all
    }

    /// Returns the number of primary rays per pixel.
    #[must_use]
    pub fn rays_per_pixel(&self) -> u32 {
        let Self { antialiasing, sampling, .. } = *self;
        RenderSettings { antialiasing, sampling, ..RenderSettings::default() }.rays_per_pixel()
    }

    /// Returns the work of rendering `scene` with this setting into `width` x `height` pixels.
    ///
    /// # Errors
    ///
    /// An invalid scene.
    pub fn work(
        &self,
        scene: &Scene,
        (width, height): (u32, u32),
    ) -> Result<Box<dyn Work + Send>, SceneError> {
        let mut scene = scene.with_arithmetic(self.arithmetic);
        scene.render.sampling = self.sampling;
        scene.render.adaptive = self.adaptive;
        scene.render.antialiasing = self.antialiasing;
        scene.render.max_reflections = self.max_reflections;
        tracer(&scene, width, height, Execution::default())
    }
}

/// Returns the depths to try: that of the scene, 1 and 0. Without a mirror, only the first.
fn depths(scene: &Scene) -> Vec<u32> {
    let mirrors = scene.materials.iter().any(|material| material.reflection > 0.0);
    let deepest = scene.render.max_reflections;
    let mut depths = vec![deepest];
    depths.extend([1, 0].into_iter().filter(|&depth| mirrors && depth < deepest));
    depths
}

/// Formats a setting as in "robust f32, 25 lattice rays, 4 bounces".
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rays = match (self.rays_per_pixel(), self.sampling) {
            (1, _) => "1 ray".to_owned(),
            (rays, Sampling::Lattice) if self.adaptive => format!("up to {rays} adaptive rays"),
            (rays, Sampling::Lattice) => format!("{rays} lattice rays"),
            (rays, Sampling::Importance) => format!("{rays} importance rays"),
        };
        let bounces = if self.max_reflections == 1 { "bounce" } else { "bounces" };
        write!(f, "{}, {rays}, {} {bounces}", self.arithmetic, self.max_reflections)
    }
}
