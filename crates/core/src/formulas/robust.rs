//! The formulas that keep their digits; those of the shapes stand beside the shapes.

use super::{Family, LightPath};
use crate::lane::{Lane, Mask, Scalar};
use crate::ray::{Ray, miss};
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle, longest_axis};
use crate::vector::Vector;
use std::ops::ControlFlow;

/// The family of [`Formulas::Robust`](super::Formulas::Robust).
#[derive(Debug)]
pub(crate) struct Robust;

impl Family for Robust {
    #[inline(always)]
    fn planes<L: Lane>(
        planes: &[Plane<L::Scalar>],
        ray: &Ray<L>,
        found: &mut impl FnMut(usize, L) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        planes.iter().enumerate().try_for_each(|(i, plane)| found(i, plane.intersect(ray)))
    }

    #[inline(always)]
    fn spheres<L: Lane>(
        spheres: &[Sphere<L::Scalar>],
        ray: &Ray<L>,
        found: &mut impl FnMut(usize, L) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let aim = sphere::Aim::new(ray);
        spheres.iter().enumerate().try_for_each(|(i, sphere)| found(i, sphere.intersect(ray, &aim)))
    }

    #[inline(always)]
    fn triangles<L: Lane>(
        triangles: &[Triangle<L::Scalar>],
        ray: &Ray<L>,
        found: &mut impl FnMut(usize, L) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let [along_x, along_y, along_z] = longest_axis(ray.direction);
        triangles_along::<L, 0>(triangles, ray, along_x, found)?;
        triangles_along::<L, 1>(triangles, ray, along_y, found)?;
        triangles_along::<L, 2>(triangles, ray, along_z, found)
    }

    #[inline(always)]
    fn cylinders<L: Lane>(
        cylinders: &[Cylinder<L::Scalar>],
        ray: &Ray<L>,
        found: &mut impl FnMut(usize, L) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let aim = cylinder::Aim::new(ray);
        cylinders.iter().enumerate().try_for_each(|(i, cylinder)| found(i, cylinder.intersect(ray, &aim)))
    }

    /// The hit is moved onto the surface: what is left of its error is bounded by the clearance.
    #[inline(always)]
    fn settle<L: Lane>(_near: Vector<L>, on_surface: SurfacePoint<L>) -> SurfacePoint<L> {
        on_surface
    }

    /// `t` counts in the way to the light, and ends a little before 1: a surface that passes through
    /// the light does not hide it. Where such a surface lies is known to about 16 roundings of the
    /// coordinates of both ends, as in the clearance of a hit.
    #[inline(always)]
    fn shadow_ray<L: Lane>(path: &LightPath<L>) -> (Ray<L>, L) {
        let uncertain = path.reach * path.inverse_distance * L::literal(16.0 * L::Scalar::ROUNDOFF);
        (Ray { origin: path.start, direction: path.toward }, L::literal(1.0) - uncertain)
    }
}

/// The triangles for the rays that are longest along `AXIS`: one ray, or a packet of similar ones,
/// takes one of the three.
#[inline(always)]
fn triangles_along<L: Lane, const AXIS: usize>(
    triangles: &[Triangle<L::Scalar>],
    ray: &Ray<L>,
    along: L::Mask,
    found: &mut impl FnMut(usize, L) -> ControlFlow<()>,
) -> ControlFlow<()> {
    if !along.any() {
        return ControlFlow::Continue(());
    }
    let aim = triangle::Aim::<L, AXIS>::new(ray);
    triangles.iter().enumerate().try_for_each(|(i, triangle)| {
        let t = triangle.intersect(ray, &aim);
        found(i, L::select(along, t, miss()))
    })
}
