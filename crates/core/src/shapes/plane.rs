//! The infinite plane.

use super::side::Side;
use super::{SurfacePoint, offset_bound};
use crate::ray::{Ray, miss};
use crate::scene;
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

/// The points `p` with `normal . (p - point) = 0`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane<S> {
    pub(crate) point: Vector<S>,
    /// The normal of the scene, scaled by a power of two. Made unit it would lose its last digits,
    /// and a ray that starts in the plane would hit it.
    pub(crate) normal: Vector<S>,
    unit_normal: Vector<S>,
    /// Set if the normal is parallel to an axis.
    across: Option<Across<S>>,
}

/// The axis of the normal, and the normal's and the point's component along it.
#[derive(Clone, Copy, Debug)]
struct Across<S> {
    axis: usize,
    normal: S,
    point: S,
}

impl<S: Scalar> Plane<S> {
    pub(crate) fn new(plane: &scene::Plane) -> Self {
        let normal = Vector::<S>::rounded(scene::near_one(plane.normal));
        let zero = S::literal(0.0);
        let others_are_zero = |axis: &usize| {
            normal.to_array().iter().enumerate().all(|(i, n)| i == *axis || n.equals(zero))
        };
        let point = Vector::<S>::rounded(plane.point);
        let across = (0..3).find(others_are_zero).map(|axis| {
            let [normal, point] = [normal, point].map(|v| v.to_array()[axis]);
            Across { axis, normal, point }
        });
        Self { point, normal, unit_normal: Vector::rounded(scene::unit(plane.normal)), across }
    }

    /// Makes the plane one that no ray hits.
    pub(crate) fn remove(&mut self) {
        (self.normal, self.across) = (Vector::zero(), None);
    }

    /// Returns `t = n . (point - origin) / n . d`. The difference comes first, so that a scene far
    /// from the origin of coordinates loses nothing. A parallel ray gives an infinity or NaN, which
    /// is a miss.
    ///
    /// Relative error of `t`, counting roundings (Higham, Accuracy and Stability of Numerical
    /// Algorithms, 2002, 3.1): at most `4u sum |n_i (point_i - o_i)| / |n . (point - o)| + 3u sum
    /// |n_i d_i| / |n . d| + u`.
    #[inline(always)]
    pub(crate) fn intersect<L: Lane<Scalar = S>>(&self, ray: &Ray<L>) -> L {
        let slope = match self.across {
            // The other products are zeros, which change no sum.
            Some(Across { axis, normal, .. }) => L::splat(normal) * component(ray.direction, axis),
            None => Vector::splat(self.normal).dot(ray.direction),
        };
        let t = self.depth(ray.origin) / slope;
        L::select(L::literal(0.0).lt(t), t, miss())
    }

    /// Returns the depth of a point below the plane, in lengths of the normal.
    #[inline(always)]
    fn depth<L: Lane<Scalar = S>>(&self, of: Vector<L>) -> L {
        match self.across {
            Some(Across { axis, normal, point }) => {
                L::splat(normal) * (L::splat(point) - component(of, axis))
            }
            None => Vector::splat(self.normal).dot(Vector::splat(self.point) - of),
        }
    }

    /// Returns whether the plane separates `start` from a point on this side of it. That is known
    /// to `4u sum |n_i (point_i - start_i)|`, which the angle of the way does not change.
    #[inline(always)]
    pub(crate) fn separates<L: Lane<Scalar = S>>(&self, start: Vector<L>, side: Side) -> L::Mask {
        let (zero, depth) = (L::literal(0.0), self.depth(start));
        match side {
            Side::Front => zero.lt(depth),
            Side::Back => depth.lt(zero),
            Side::Unknown => zero.lt(zero),
        }
    }

    /// Returns the point of the plane that is closest to `near`.
    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>>(&self, near: Vector<L>) -> SurfacePoint<L> {
        let (anchor, normal) = (Vector::splat(self.point), Vector::splat(self.unit_normal));
        let point = near - normal * normal.dot(near - anchor);
        SurfacePoint { point, normal, offset_bound: offset_bound(normal, point, anchor.abs()) }
    }
}

#[inline(always)]
fn component<L: Lane>(v: Vector<L>, axis: usize) -> L {
    match axis {
        0 => v.x,
        1 => v.y,
        _ => v.z,
    }
}
