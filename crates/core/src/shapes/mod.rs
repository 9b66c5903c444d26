//! Where a ray meets each kind of primitive.
//!
//! A shape is stored in the precision of the picture. Its `intersect` returns the smallest `t > 0`
//! at which a ray meets it, or [`miss`](crate::ray::miss), which is infinite: so "nearer than" is
//! one comparison, and NaN, from input that means nothing, is never nearer. What of a ray is the
//! same for all shapes of a kind is computed once, as the kind's `RayPrecomputation`.

pub(crate) mod aabb;
pub(crate) mod cylinder;
pub(crate) mod plane;
mod quadric;
pub(crate) mod shape_list;
pub(crate) mod sphere;
pub(crate) mod triangle;

use crate::simd::lane::Lane;
use crate::simd::vector::Vector;

/// By how many roundings of the largest coordinates whatever rules a shape out is larger than the
/// shape. Hits are off by 31 at the most: of a sphere, 12 in each of the coordinates and the
/// radius, over three axes.
pub(crate) const MARGIN: f64 = 64.0;

/// A point on a surface, with what rounding left uncertain about it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint<L> {
    /// The hit, moved onto the surface: its error is no longer that of `t`.
    pub(crate) point: Vector<L>,
    /// Of unit length, on either side.
    pub(crate) normal: Vector<L>,
    /// How far from `point` a ray has to start, along the normal, to be on one side of the surface
    /// for certain.
    pub(crate) offset_bound: L,
}

impl<L: Lane> SurfacePoint<L> {
    /// Where rays that leave on the normal's side start.
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

/// A bound on the distance between a computed point on a surface and the surface, as the next
/// intersection with it computes that distance.
///
/// Both are sums of products of components of the normal with coordinates of the point and of the
/// shape, so each rounding adds at most `u |n_i| (|point_i| + reach_i)` a component, where `reach`
/// bounds the shape's own coordinates. Twelve roundings cover each shape here: at most four in
/// finding the point's distance, two in moving it, two in moving the start of the next ray, four
/// in its own distance. The idea, with gamma(3) to gamma(7), is that of pbrt ("Managing Rounding
/// Error": Pharr, Jakob, Humphreys, 2016); unlike a constant it follows the scene's scale.
#[inline(always)]
fn offset_bound<L: Lane>(normal: Vector<L>, point: Vector<L>, reach: Vector<L>) -> L {
    use crate::simd::lane::Scalar;
    normal.abs().dot(point.abs() + reach) * L::literal(12.0 * L::Scalar::ROUNDOFF)
}
