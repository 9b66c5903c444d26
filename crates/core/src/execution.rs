//! The settings of a rendering that never change the image: packets, sharing, acceleration.

use crate::precision::{F32_MIRRORS, PrecisionEstimate};
use crate::settings::Precision;

/// The settings that never change a bit of the image, only the time that it takes.
///
/// The settings that change the image are in [`RenderSettings`](crate::scene::RenderSettings). The
/// tile size never changes it either, but it belongs to the strategy: the tracer fills any tile.
///
/// The default is the fastest for most scenes: full packets, shared samples, acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Execution {
    /// The number of rays that are followed side by side.
    pub lanes: Lanes,
    /// Traces a lattice point once for all pixels of a tile that need it. Adaptive samples are
    /// always shared.
    pub share_samples: bool,
    /// The acceleration structure.
    pub acceleration: Acceleration,
}

/// The acceleration structure that lets rays skip primitives.
///
/// The textbook's formulas always try each of them: their errors have no bound, so what they would
/// find depends on what they try.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Acceleration {
    /// Skips primitives that the ray cannot hit: by a BVH among many primitives; among few by
    /// direction cones seen from the eye, its mirror images and the lights, and by spheres around
    /// triangles.
    #[default]
    Auto,
    /// Tries each primitive: the definition that the other is tested against.
    None,
}

/// The number of rays that are followed side by side, as a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One ray.
    One,
    /// A packet that fills 256 bits: 8 in `f32`, 4 in `f64`.
    Wide256,
    /// A packet that fills 512 bits: 16 in `f32`, 8 in `f64`.
    Wide512,
}

impl Default for Execution {
    fn default() -> Self {
        Self { lanes: Lanes::default(), share_samples: true, acceleration: Acceleration::default() }
    }
}

/// The default fills a register of the machine that the program is built for, but at least 256
/// bits.
impl Default for Lanes {
    fn default() -> Self {
        if cfg!(target_feature = "avx512f") { Self::Wide512 } else { Self::Wide256 }
    }
}

impl Lanes {
    /// All widths.
    pub const ALL: [Self; 3] = [Self::One, Self::Wide256, Self::Wide512];

    /// Returns the number of rays in this precision.
    #[must_use]
    pub fn count(self, precision: Precision) -> usize {
        match (self, precision) {
            (Self::One, _) => 1,
            (Self::Wide256, Precision::F32) | (Self::Wide512, Precision::F64) => 8,
            (Self::Wide256, Precision::F64) => 4,
            (Self::Wide512, Precision::F32) => 16,
        }
    }

    /// Returns the width that is likely the fastest for the scene of this estimate.
    ///
    /// The rays of neighbouring pixels diverge between curved mirrors as fast as errors grow there.
    /// Where that is too much for `f32`, the rays of a packet soon have nothing in common, so each
    /// ray is followed alone.
    #[must_use]
    pub fn suggested(estimate: &PrecisionEstimate) -> Self {
        if estimate.mirrors <= F32_MIRRORS { Self::default() } else { Self::One }
    }
}
