//! The interface of a family of formulas, and the values it works on.

use crate::ray::Ray;
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::side::Side;
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle};
use crate::simd::lane::Lane;
use crate::simd::vector::Vector;
use std::fmt::Debug;

/// A family of formulas, for which the tracer is compiled.
///
/// The first four functions return the smallest `t` that counts as a hit, or
/// [`miss`](crate::ray::miss). For rays that are not in `wanted` they may return a miss without
/// computing anything.
pub(crate) trait Family: Debug + Send + Sync + 'static {
    /// True if the formulas err by no more than a few roundings of the coordinates. Then a box that
    /// is enlarged by more than these roundings holds every hit, and nothing is hit behind a plane.
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

    /// Returns the point at which rays leave a surface that was hit `near` it, given the closest
    /// point of the surface.
    fn snap_to_surface<L: Lane>(near: Vector<L>, on_surface: SurfacePoint<L>) -> SurfacePoint<L>;

    /// Returns the ray along a path to a light, and the `t` of its end.
    fn shadow_ray<L: Lane>(path: &LightPath<L>) -> (Ray<L>, L);

    /// Returns whether a plane hides the light at the end of a shadow ray, on this side of it.
    fn plane_hides<L: Lane>(
        plane: &Plane<L::Scalar>,
        ray: &Ray<L>,
        limit: L,
        side: Side,
    ) -> L::Mask;
    /// Returns whether a sphere hides the light at the end of a shadow ray. If the formulas' errors
    /// are bounded, the light is not near the sphere.
    fn sphere_hides<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &sphere::RayPrecomputation<L>,
        wanted: L::Mask,
        limit: L,
    ) -> L::Mask;
    /// Returns whether a triangle hides the light at the end of a shadow ray, on this side of it.
    fn triangle_hides<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &triangle::RayPrecomputation<L>,
        wanted: L::Mask,
        limit: L,
        side: impl FnOnce() -> Side,
    ) -> L::Mask;
    /// Returns whether a cylinder hides the light at the end of a shadow ray. If the formulas'
    /// errors are bounded, the light is not near the cylinder.
    fn cylinder_hides<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &cylinder::RayPrecomputation<L>,
        wanted: L::Mask,
        limit: L,
    ) -> L::Mask;
}

/// The part of the formulas that depends on the ray alone, for each kind of shape that the scene
/// has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayPrecomputations<L> {
    pub(crate) sphere: sphere::RayPrecomputation<L>,
    pub(crate) triangle: triangle::RayPrecomputation<L>,
    pub(crate) cylinder: cylinder::RayPrecomputation<L>,
}

/// The path from a surface to a light.
pub(crate) struct LightPath<L> {
    /// The start of the path, off the surface.
    pub(crate) start: Vector<L>,
    /// The vector from there to the light.
    pub(crate) toward: Vector<L>,
    /// The same at unit length.
    pub(crate) to_light: Vector<L>,
    /// The length of the path.
    pub(crate) distance: L,
}
