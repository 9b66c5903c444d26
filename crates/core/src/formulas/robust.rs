//! The robust formulas, which keep their digits. Those of the shapes are written beside the shapes.

use super::family::{Family, LightPath};
use crate::ray::Ray;
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::side::Side;
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle};
use crate::simd::lane::Lane;
use crate::simd::vector::Vector;

/// The family of [`Formulas::Robust`](crate::Formulas::Robust).
#[derive(Debug)]
pub(crate) struct Robust;

impl Family for Robust {
    const ERROR_BOUNDED: bool = true;

    #[inline(always)]
    fn plane<L: Lane>(plane: &Plane<L::Scalar>, ray: &Ray<L>) -> L {
        plane.intersect(ray)
    }

    #[inline(always)]
    fn sphere<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &sphere::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        sphere.intersect(ray, precomputed, wanted)
    }

    #[inline(always)]
    fn triangle<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &triangle::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        triangle.intersect(ray, precomputed, wanted)
    }

    #[inline(always)]
    fn cylinder<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &cylinder::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        cylinder.intersect(ray, precomputed, wanted)
    }

    /// Moves the hit onto the surface. The rest of its error is at most the offset bound.
    #[inline(always)]
    fn snap_to_surface<L: Lane>(_near: Vector<L>, on_surface: SurfacePoint<L>) -> SurfacePoint<L> {
        on_surface
    }

    /// Measures `t` in units of the path.
    #[inline(always)]
    fn shadow_ray<L: Lane>(path: &LightPath<L>) -> (Ray<L>, L) {
        (Ray { origin: path.start, direction: path.toward }, L::literal(1.0))
    }

    #[inline(always)]
    fn plane_hides<L: Lane>(
        plane: &Plane<L::Scalar>,
        ray: &Ray<L>,
        _limit: L,
        side: Side,
    ) -> L::Mask {
        plane.separates(ray.origin, side)
    }

    #[inline(always)]
    fn sphere_hides<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &sphere::RayPrecomputation<L>,
        wanted: L::Mask,
        _limit: L,
    ) -> L::Mask {
        sphere.hides(ray, precomputed, wanted)
    }

    #[inline(always)]
    fn triangle_hides<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &triangle::RayPrecomputation<L>,
        wanted: L::Mask,
        _limit: L,
        side: impl FnOnce() -> Side,
    ) -> L::Mask {
        triangle.hides(ray, precomputed, wanted, side)
    }

    #[inline(always)]
    fn cylinder_hides<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &cylinder::RayPrecomputation<L>,
        wanted: L::Mask,
        _limit: L,
    ) -> L::Mask {
        cylinder.hides(ray, precomputed, wanted)
    }
}
