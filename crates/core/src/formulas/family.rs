//! The interface of a family of formulas, and the values it works on.

use crate::ray::Ray;
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle};
use crate::simd::lane::Lane;
use crate::simd::vector::Vector;
use std::fmt::Debug;

/// A family of formulas, as the tracer is compiled for it.
///
/// The first four give the smallest `t` that counts as a hit, or [`miss`](crate::ray::miss); so too
/// for rays that are not in `wanted`, which need not be computed.
pub(crate) trait Family: Debug + Send + Sync + 'static {
    /// Whether the formulas err by no more than a few roundings of the coordinates. Then boxes that
    /// are larger by some more of them are missed by no hit, and nothing is hit behind a plane.
    const ERROR_BOUNDED: bool;

    fn plane<L: Lane>(plane: &Plane<L::Scalar>, ray: &Ray<L>) -> L;
    fn sphere<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &sphere::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L;
    fn triangle<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &triangle::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L;
    fn cylinder<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &cylinder::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L;

    /// What becomes of the hit `near` a surface, given the surface's own point next to it.
    fn snap_to_surface<L: Lane>(near: Vector<L>, on_surface: SurfacePoint<L>) -> SurfacePoint<L>;

    /// The ray along a path to a light, and the `t` that a surface has to be nearer than to hide
    /// it.
    fn shadow_ray<L: Lane>(path: &LightPath<L>) -> (Ray<L>, L);
}

/// What of a ray is the same for all shapes of a kind: computed once, for kinds that are there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayPrecomputations<L> {
    pub(crate) sphere: sphere::RayPrecomputation<L>,
    pub(crate) triangle: triangle::RayPrecomputation<L>,
    pub(crate) cylinder: cylinder::RayPrecomputation<L>,
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
