//! Two families of formulas for where rays meet shapes, and how they leave them again.
//!
//! What a scene means, how it is lit and how often rays bounce is the same for both; they differ in
//! what rounding does to them. So speed can be held against error.

mod robust;
mod textbook;

pub(crate) use robust::Robust;
pub(crate) use textbook::Textbook;

use crate::precision::Precision;
use crate::ray::Ray;
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle};
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;
use std::fmt::{self, Debug};

/// Which formulas a tracer uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulas {
    /// What the lab report writes, its slips mended: `b^2 - 4ac`, a plane and three cross products
    /// for a triangle, hits nearer than 1e-3 ignored.
    Textbook,
    /// Formulas that keep their digits: roots from the closest approach, watertight triangles,
    /// rays that leave a surface by the error bound of the hit point.
    #[default]
    Robust,
}

/// How a tracer computes: with which formulas, in which number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arithmetic {
    /// The formulas.
    pub formulas: Formulas,
    /// The number type.
    pub precision: Precision,
}

/// What is compiled once for each arithmetic: the number type and the formulas are type parameters.
pub(crate) trait Compiled {
    type Output;

    fn compiled<S: Scalar, F: Family>(self) -> Self::Output;
}

impl Arithmetic {
    /// `what` in this arithmetic.
    pub(crate) fn select<C: Compiled>(self, what: C) -> C::Output {
        match (self.formulas, self.precision) {
            (Formulas::Robust, Precision::F32) => what.compiled::<f32, Robust>(),
            (Formulas::Robust, Precision::F64) => what.compiled::<f64, Robust>(),
            (Formulas::Textbook, Precision::F32) => what.compiled::<f32, Textbook>(),
            (Formulas::Textbook, Precision::F64) => what.compiled::<f64, Textbook>(),
        }
    }
}

/// Formulas and number type, as in "robust f32".
impl fmt::Display for Arithmetic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.formulas, self.precision)
    }
}

/// The robust formulas in this precision.
impl From<Precision> for Arithmetic {
    fn from(precision: Precision) -> Self {
        Self { formulas: Formulas::Robust, precision }
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

/// A family of formulas, as the tracer is compiled for it.
///
/// The first four give the smallest `t` that counts as a hit, or [`miss`](crate::ray::miss); so too
/// for rays that are not in `wanted`, which need not be computed.
pub(crate) trait Family: Debug + Send + Sync + 'static {
    /// Whether the formulas err by no more than a few roundings of the coordinates. Then boxes that
    /// are larger by some more of them are missed by no hit, and nothing is hit behind a plane.
    const FAITHFUL: bool;

    fn plane<L: Lane>(plane: &Plane<L::Scalar>, ray: &Ray<L>) -> L;
    fn sphere<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        aim: &sphere::Aim<L>,
        wanted: L::Mask,
    ) -> L;
    fn triangle<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        aim: &triangle::Aim<L>,
        wanted: L::Mask,
    ) -> L;
    fn cylinder<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        aim: &cylinder::Aim<L>,
        wanted: L::Mask,
    ) -> L;

    /// What becomes of the hit `near` a surface, given the surface's own point next to it.
    fn settle<L: Lane>(near: Vector<L>, on_surface: SurfacePoint<L>) -> SurfacePoint<L>;

    /// The ray along a path to a light, and the `t` that a surface has to be nearer than to hide
    /// it.
    fn shadow_ray<L: Lane>(path: &LightPath<L>) -> (Ray<L>, L);
}

/// What of a ray is the same for all shapes of a kind: computed once, for kinds that are there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim<L> {
    pub(crate) sphere: sphere::Aim<L>,
    pub(crate) triangle: triangle::Aim<L>,
    pub(crate) cylinder: cylinder::Aim<L>,
}

/// The way from a surface to a light.
pub(crate) struct LightPath<L> {
    /// Where it begins, off the surface.
    pub(crate) start: Vector<L>,
    /// From there to the light.
    pub(crate) toward: Vector<L>,
    /// The same at unit length.
    pub(crate) to_light: Vector<L>,
    /// The length.
    pub(crate) distance: L,
    /// One over it.
    pub(crate) inverse_distance: L,
    /// The sum of the magnitudes of the coordinates of both ends.
    pub(crate) reach: L,
}
