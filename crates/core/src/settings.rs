//! The settings of a rendering that change the image: formulas, precision, sampling, bounces.
//!
//! The settings that do not are in [`Execution`](crate::Execution).

use crate::fault::{SceneFault, color, expect};
use glam::DVec3;
use std::fmt;

/// The settings that change the image, apart from its size.
///
/// With the scene and the image's size they determine every bit. [`Execution`](crate::Execution)
/// holds the settings that change only the time a rendering takes.
///
/// A scene file states the background, the bounces and the density; a program chooses the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// The colour of a ray that hits nothing.
    pub background: DVec3,
    /// Mirror bounces after the primary ray, 0..=64.
    pub max_reflections: u32,
    /// Density `s` of the samples: 0 for one ray a pixel, else 1..=32; see [`Sampling`].
    pub antialiasing: u32,
    /// The pattern of the samples in and around a pixel.
    pub sampling: Sampling,
    /// Interpolates lattice points between pixel centres that hit the same primitive under the same
    /// lights, directly and in mirrors; traces the others. Has no effect on samples that are not on
    /// the lattice.
    pub adaptive: bool,
    /// Formulas and number type.
    pub arithmetic: Arithmetic,
}

/// The largest value of [`RenderSettings::max_reflections`].
pub const MAX_REFLECTIONS: u32 = 64;
/// The largest value of [`RenderSettings::antialiasing`].
pub const MAX_ANTIALIASING: u32 = 32;

/// The pattern of the samples of a pixel. Both patterns are the same for every pixel, and tend to
/// the integral of the filter over the image as their number grows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// `(2 s + 1)^2` samples on a square lattice, weighted by the filter: the meaning of a scene
    /// file.
    #[default]
    Lattice,
    /// `s^2 + (s + 1)^2` samples of equal weight, distributed like the filter: half of the
    /// lattice's rays for about the same error.
    Importance,
}

/// The formulas that a tracer uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulas {
    /// The formulas of the lab report, with its errors corrected: `b^2 - 4ac`, a plane and three
    /// cross products for a triangle, hits nearer than 1e-3 ignored.
    Textbook,
    /// Formulas that keep their digits: roots from the closest approach, watertight triangles,
    /// rays that leave a surface by the error bound of the hit point.
    #[default]
    Robust,
}

/// The number type that an image is computed in; images are stored as `f32` in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 24 binary digits.
    F32,
    /// 53 binary digits.
    #[default]
    F64,
}

/// The formulas and the number type of a rendering.
///
/// The default is the robust formulas in `f64`, which are right for every scene. Where `f32` is
/// enough, [`PrecisionEstimate`](crate::precision::PrecisionEstimate) says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arithmetic {
    /// The formulas.
    pub formulas: Formulas,
    /// The number type.
    pub precision: Precision,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            background: DVec3::ZERO,
            max_reflections: 4,
            antialiasing: 2,
            sampling: Sampling::Lattice,
            adaptive: false,
            arithmetic: Arithmetic::default(),
        }
    }
}

impl RenderSettings {
    /// Returns whether the samples lie on a lattice, whose points neighbouring pixels share.
    #[must_use]
    pub fn has_lattice(&self) -> bool {
        self.antialiasing > 0 && self.sampling == Sampling::Lattice
    }

    /// Returns the number of primary rays a pixel, if each pixel traces its own.
    #[must_use]
    pub fn rays_per_pixel(&self) -> u32 {
        match (self.antialiasing, self.sampling) {
            (0, _) => 1,
            (density, Sampling::Lattice) => (2 * density + 1).pow(2),
            (density, Sampling::Importance) => density.pow(2) + (density + 1).pow(2),
        }
    }

    /// Checks that the settings are within the model's limits.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        color("background", self.background)?;
        let reflections = self.max_reflections;
        expect(
            "max_reflections",
            reflections <= MAX_REFLECTIONS,
            "an integer in 0..=64",
            reflections,
        )?;
        let density = self.antialiasing;
        expect("antialiasing", density <= MAX_ANTIALIASING, "an integer in 0..=32", density)
    }
}

/// The robust formulas in this precision.
impl From<Precision> for Arithmetic {
    fn from(precision: Precision) -> Self {
        Self { formulas: Formulas::Robust, precision }
    }
}

impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lattice => "lattice",
            Self::Importance => "importance",
        })
    }
}

impl fmt::Display for Formulas {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Textbook => "textbook",
            Self::Robust => "robust",
        })
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}

/// Writes formulas and number type, as in "robust f32".
impl fmt::Display for Arithmetic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.formulas, self.precision)
    }
}
