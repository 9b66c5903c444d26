//! The sides of surfaces that a point is on, as far as rounding lets them be told.

use crate::scene::{Plane, unit};
use crate::simd::lane::Scalar;
use glam::DVec3;

/// The side of a plane that a point is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// The normal's side.
    Front,
    Back,
    /// Too near to the plane to tell, given rounding.
    Unknown,
}

/// The roundings up to which a point counts as lying in a surface. Three numbers that were rounded
/// as they were written (the point, the surface's position, and its normal or radius) make up to
/// four roundings of the coordinates, and computing the distance makes five. The rest is for points
/// that were computed before they were written.
pub(crate) const IN_SURFACE: f64 = 16.0;

/// Half an ulp of 1 in `f64`, in which scenes are written.
pub(crate) const WRITTEN: f64 = f64::ROUNDOFF;

impl Side {
    /// Returns the side of a plane at this height above it, known up to `error`.
    fn at(height: f64, error: f64) -> Self {
        if height > error {
            Self::Front
        } else if height < -error {
            Self::Back
        } else {
            Self::Unknown
        }
    }

    /// Returns the side of `plane` that `point` is on, if it is farther from it than this many
    /// roundings.
    pub(crate) fn of_plane(plane: &Plane, point: DVec3, roundings: f64) -> Self {
        let normal = unit(plane.normal);
        let height = normal.dot(point - plane.point);
        Self::at(height, roundings * normal.abs().dot(point.abs() + plane.point.abs()))
    }

    /// Returns the side of `plane` that `point` is on as they are written.
    pub(crate) fn as_written(plane: &Plane, point: DVec3) -> Self {
        Self::of_plane(plane, point, IN_SURFACE * WRITTEN)
    }

    /// Returns the side of the plane through a triangle's corners, whose coordinates are known up
    /// to `roundoff`.
    pub(crate) fn of_corners([a, b, c]: [DVec3; 3], point: DVec3, roundoff: f64) -> Self {
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let reach = a.abs().max(b.abs()).max(c.abs()) + point.abs();
        // Each component of the normal is a difference of two products, of factors that are
        // differences. Its error of `4u` of both products is all of it in a sliver.
        let (p, q) = (ab.abs(), ac.abs());
        let products =
            DVec3::new(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
        let error = IN_SURFACE * roundoff * normal.abs().dot(reach)
            + 4.0 * WRITTEN * products.dot((point - a).abs());
        Self::at(normal.dot(point - a), error)
    }
}
