//! The knobs that trade speed for error, and which positions of them are tried.

use rayweave_contract::Work;
use rayweave_core::scene::{RenderSettings, SceneError};
use rayweave_core::{Arithmetic, Execution, Formulas, Precision, Sampling, Scene, tracer};
use std::fmt;

/// One position of every knob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Formulas and number type.
    pub arithmetic: Arithmetic,
    /// Where samples lie; of no consequence for one ray a pixel.
    pub sampling: Sampling,
    /// Whether lattice points are interpolated where pixels look alike.
    pub adaptive: bool,
    /// Density `s`, as in [`rayweave_core::scene::RenderSettings::antialiasing`].
    pub antialiasing: u32,
    /// Mirror bounces after the primary ray.
    pub max_reflections: u32,
}

/// The densities that are tried: 1 to 289 rays a pixel on the lattice.
pub const DENSITIES: [u32; 7] = [0, 1, 2, 3, 4, 6, 8];

/// The most exact arithmetic, whose images the others' are compared with.
pub const EXACT: Arithmetic = Arithmetic { formulas: Formulas::Robust, precision: Precision::F64 };

/// All arithmetics, the most exact one first.
pub const ARITHMETICS: [Arithmetic; 4] = [
    EXACT,
    Arithmetic { formulas: Formulas::Robust, precision: Precision::F32 },
    Arithmetic { formulas: Formulas::Textbook, precision: Precision::F64 },
    Arithmetic { formulas: Formulas::Textbook, precision: Precision::F32 },
];

impl Setting {
    /// The lab report's own: its formulas in `f32`, 5 x 5 rays a pixel, all bounces that the scene
    /// has.
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

    /// Every setting that is tried on `scene`, those that differ in their arithmetic alone
    /// together, the most exact one first; before settings of less depth come those of the scene's
    /// own.
    #[must_use]
    pub fn all(scene: &Scene) -> Vec<Self> {
        let mut all = Vec::new();
        let patterns =
            [(Sampling::Lattice, false), (Sampling::Importance, false), (Sampling::Lattice, true)];
        for (sampling, adaptive) in patterns {
            for antialiasing in DENSITIES {
                // One ray a pixel is the same in all; on a lattice of one step a pixel all points
                // are centres.
                let same = sampling == Sampling::Importance || adaptive;
                if (antialiasing == 0 && same) || (antialiasing == 1 && adaptive) {
                    continue;
                }
                // Adaptive samples of less depth would only repeat what the others tell of depth.
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

    /// Primary rays a pixel.
    #[must_use]
    pub fn rays_per_pixel(&self) -> u32 {
        let Self { antialiasing, sampling, .. } = *self;
        RenderSettings { antialiasing, sampling, ..RenderSettings::default() }.rays_per_pixel()
    }

    /// The work of rendering `scene` with this setting into `width` x `height` pixels.
    ///
    /// # Errors
    ///
    /// A scene that is not sound.
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

/// As many bounces as the scene has, one, none; without a mirror they are all the same.
fn depths(scene: &Scene) -> Vec<u32> {
    let mirrors = scene.materials.iter().any(|material| material.reflection > 0.0);
    let deepest = scene.render.max_reflections;
    let mut depths = vec![deepest];
    depths.extend([1, 0].into_iter().filter(|&depth| mirrors && depth < deepest));
    depths
}

/// As in "robust f32, 25 lattice rays, 4 bounces".
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
