//! How a picture is computed: with which arithmetic, and by which ways that give the same bits.

use crate::formulas::Arithmetic;
use crate::precision::Precision;

/// How a picture is computed. Only the arithmetic changes its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Execution {
    /// Formulas and number type.
    pub arithmetic: Arithmetic,
    /// Rays side by side.
    pub lanes: Lanes,
    /// Whether a lattice point that several pixels of a tile need is traced once; of adaptive
    /// samples it always is.
    pub share_samples: bool,
    /// Whether a ray tries what it cannot meet.
    pub search: Search,
}

/// Which primitives a ray tries. With the textbook's formulas it is always each of them: what they
/// would find there depends on where they look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Search {
    /// What the scene's shape does not rule out: by cones of directions around the eye, its images
    /// and the lights, and by spheres around triangles; or, among many primitives, by a tree of
    /// boxes.
    #[default]
    Auto,
    /// Each: the definition, to hold the other against.
    Exhaustive,
}

/// How many rays are followed side by side, as a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// As many as fill 256 bits: 8 in `f32`, 4 in `f64`.
    Wide256,
    /// As many as fill 512 bits: 16 in `f32`, 8 in `f64`.
    Wide512,
}

/// As many as fill a register of the machine that the program is built for; 256 bits if it is
/// smaller.
impl Default for Lanes {
    fn default() -> Self {
        if cfg!(target_feature = "avx512f") { Self::Wide512 } else { Self::Wide256 }
    }
}

impl Lanes {
    /// Each width there is.
    pub const ALL: [Self; 3] = [Self::One, Self::Wide256, Self::Wide512];

    /// The number of rays in this precision.
    #[must_use]
    pub fn count(self, precision: Precision) -> usize {
        match (self, precision) {
            (Self::One, _) => 1,
            (Self::Wide256, Precision::F32) | (Self::Wide512, Precision::F64) => 8,
            (Self::Wide256, Precision::F64) => 4,
            (Self::Wide512, Precision::F32) => 16,
        }
    }
}

/// The fastest execution in this arithmetic: packets, and samples shared.
impl<A: Into<Arithmetic>> From<A> for Execution {
    fn from(arithmetic: A) -> Self {
        Self {
            arithmetic: arithmetic.into(),
            lanes: Lanes::default(),
            share_samples: true,
            search: Search::default(),
        }
    }
}
