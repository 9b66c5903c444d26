//! The shapes: where a ray meets each kind of primitive, and where the next ray leaves it.
//!
//! A shape is stored in the precision of the image. Its `intersect` returns the smallest `t > 0` at
//! which a ray meets it, or [`miss`](crate::ray::miss), which is infinite. So "closer than" is one
//! comparison, and NaN, from degenerate input, is never closer. The part that depends on the ray
//! alone is computed once for all shapes of a kind, as the kind's `RayPrecomputation`.

pub(crate) mod aabb;
pub(crate) mod cylinder;
pub(crate) mod plane;
pub(crate) mod quadric;
pub(crate) mod shape_list;
pub(crate) mod side;
pub(crate) mod sphere;
pub(crate) mod triangle;

use crate::simd::lane::Lane;
use crate::simd::vector::Vector;

/// The margin by which every culling volume is larger than its shape, in roundings of the largest
/// coordinates. A hit is off by at most 31 roundings: for a sphere, by 12 in each of the
/// coordinates and the radius, over three axes.
pub(crate) const MARGIN: f64 = 64.0;

/// A point on a surface, its normal, and a bound on its rounding error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint<L> {
    /// The hit, moved onto the surface, so that its error is no longer that of `t`.
    pub(crate) point: Vector<L>,
    /// The normal of unit length, on either side.
    pub(crate) normal: Vector<L>,
    /// The distance from `point` along the normal from which on a ray certainly starts on one side
    /// of the surface.
    pub(crate) offset_bound: L,
}

impl<L: Lane> SurfacePoint<L> {
    /// Returns the point at which rays leave on the normal's side.
    #[inline(always)]
    pub(crate) fn start(&self) -> Vector<L> {
        self.point + self.normal * self.offset_bound
    }

    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            point: Vector::select(mask, yes.point, no.point),
            normal: Vector::select(mask, yes.normal, no.normal),
            offset_bound: L::select(mask, yes.offset_bound, no.offset_bound),
        }
    }
}

/// The roundings of its coordinates by which the height of a point above a surface is off, at most.
pub(crate) const ROUNDINGS: f64 = 12.0;

/// Returns a bound on the distance between a computed point on a surface and the surface, as the
/// next intersection computes that distance.
///
/// Both are sums of products of components of the normal with coordinates of the point and of the
/// shape. So each rounding adds at most `u |n_i| (|point_i| + reach_i)` a component, where `reach`
/// bounds the shape's own coordinates. Twelve roundings cover each shape here: at most four in
/// finding the point's distance, two in moving it, two in moving the start of the next ray, four in
/// its own distance. The idea, with gamma(3) to gamma(7), is that of pbrt ("Managing Rounding
/// Error": Pharr, Jakob, Humphreys, 2016). Unlike a constant, the bound follows the scene's scale.
#[inline(always)]
fn offset_bound<L: Lane>(normal: Vector<L>, point: Vector<L>, reach: Vector<L>) -> L {
    use crate::simd::lane::Scalar;
    normal.abs().dot(point.abs() + reach) * L::literal(ROUNDINGS * L::Scalar::ROUNDOFF)
}
