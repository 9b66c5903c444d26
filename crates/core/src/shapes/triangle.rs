//! The triangle: its edges are included, and neighbours meet without gaps.

use super::aabb::Aabb;
use super::side::Side;
use super::{SurfacePoint, offset_bound};
use crate::ray::{AxisOrder, Ray, miss};
use crate::scene;
use crate::simd::lane::{Lane, Mask, Scalar, sign_of_difference};
use crate::simd::vector::Vector;
use glam::DVec3;

/// A triangle in the precision of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle<S> {
    pub(crate) vertices: [Vector<S>; 3],
    /// The normal, of a length near 1: making it unit would cost digits. Zero if rounding took the
    /// triangle's area; then no ray hits it.
    pub(crate) normal: Vector<S>,
    /// A corner, of this triangle or of another in the same plane: the point from which `t` is
    /// computed.
    pub(crate) anchor: Vector<S>,
    /// The distance by which `t` may lie beyond the corners, as a share of the coordinates: 0 for a
    /// triangle that shares its plane with no other.
    slack: S,
    unit_normal: Vector<S>,
}

/// The part of the formulas that depends on the ray alone, for rays with one dominant axis: the
/// shear that turns them into this axis. Triangles are then tested in the two other coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayPrecomputation<L> {
    /// The axes in the order in which coordinates are taken.
    order: AxisOrder,
    /// The rays' origin, in this order.
    origin: [L; 3],
    shear: [L; 2],
    /// The direction's component along the last axis.
    along: L,
}

impl<L: Lane> RayPrecomputation<L> {
    /// Returns a placeholder, for scenes without triangles.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        let zero = L::literal(0.0);
        Self { order: [0, 1, 2], origin: [zero; 3], shear: [zero; 2], along: zero }
    }

    #[inline(always)]
    pub(crate) fn new(ray: &Ray<L>, order: AxisOrder) -> Self {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let [x, y, z] = order.map(|axis| direction[axis]);
        Self { order, origin: order.map(|axis| origin[axis]), shear: [x / z, y / z], along: z }
    }

    /// Returns the position of `v` beside the ray, and along the axis. It is the same rounded point
    /// for every triangle that shares `v`.
    #[inline(always)]
    fn project(&self, v: Vector<L::Scalar>) -> [L; 3] {
        let coordinates = v.to_array();
        let from_origin = |i: usize| L::splat(coordinates[self.order[i]]) - self.origin[i];
        let (x, y, z) = (from_origin(0), from_origin(1), from_origin(2));
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }
}

impl<S: Scalar> Triangle<S> {
    pub(crate) fn new(triangle: &scene::Triangle) -> Self {
        // The plane is that of the rounded corners, because the scene's corners may lie on another.
        let vertices = triangle.vertices.map(Vector::rounded);
        let [a, b, c] = vertices.map(Vector::widened);
        let normal =
            if scene::parallel(b - a, c - a) { DVec3::ZERO } else { scene::normal([a, b, c]) };
        let unit_normal = normal.normalize_or_zero();
        let [normal, unit_normal] = [normal, unit_normal].map(Vector::rounded);
        Self { vertices, normal, anchor: vertices[0], slack: S::literal(0.0), unit_normal }
    }

    /// Makes the triangle one that no ray hits.
    pub(crate) fn remove(&mut self) {
        self.normal = Vector::zero();
    }

    /// Gives the triangle the plane of `other`, which is its own as they are written. Then `t` is
    /// the same for all that share it.
    ///
    /// The plane is that of the corners before they were rounded, and known to one rounding of its
    /// normal and its point, wherever it lies. `t` may leave the range of the corners by its
    /// rounding error, since the range differs: by 16 roundings of the sums of the coordinates,
    /// which is less than [`MARGIN`](super::MARGIN) of the largest.
    pub(crate) fn share_plane(&mut self, other: &scene::Triangle) {
        let normal = scene::normal(other.vertices);
        let turned = if normal.dot(self.normal.widened()) < 0.0 { -normal } else { normal };
        self.normal = Vector::rounded(turned);
        self.unit_normal = Vector::rounded(turned.normalize_or_zero());
        self.anchor = Vector::rounded(other.vertices[0]);
        self.slack = S::from_f64(16.0 * S::ROUNDOFF);
    }

    /// Returns the largest magnitude of each coordinate.
    fn reach(&self) -> Vector<S> {
        let [a, b, c] = self.vertices;
        a.abs().max(b.abs()).max(c.abs())
    }

    /// Returns the box around it.
    pub(crate) fn bounds(&self) -> Aabb<S> {
        let [a, b, c] = self.vertices;
        Aabb::new(a.min(b).min(c), a.max(b).max(c))
    }

    /// Returns the `t` at which the ray hits the triangle.
    ///
    /// The edge test is that of Woop, Benthin and Wald (Watertight Ray/Triangle Intersection, JCGT
    /// 2013): signs of 2 x 2 determinants of projected corners, which are the same from both sides
    /// of a shared edge. `t` is that of the plane: differences come first, and the sums have twice
    /// the digits, since few rays come that far. Where the ray grazes the plane, `t` is mostly
    /// noise all the same, so it is clamped to the range of the corners.
    ///
    /// The corners are projected to within `3u` of their coordinates, and then every sign is exact.
    /// Relative error of `t` in `f32`, whose corners `f64` turns into a normal without a loss: at
    /// most `2u sum |n_i (a_i - o_i)| / |n . (a - o)| + u sum |n_i d_i| / |n . d| + 3u`. These are
    /// the rounded normal and differences, then two sums and a quotient rounded once.
    #[inline(always)]
    pub(crate) fn intersect<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        let zero = L::literal(0.0);
        let (inside, [a, b, c]) = self.crossed(precomputed, wanted);
        if !inside.any() {
            return miss();
        }
        let normal = Vector::splat(self.normal);
        let slope = normal.accurate_dot(ray.direction);
        let t = normal.accurate_dot(Vector::splat(self.anchor) - ray.origin) / slope;
        let (lowest, highest) = (a.min(b).min(c), a.max(b).max(c));
        let (lowest, highest) = if S::literal(0.0).lt(self.slack) {
            let reach = L::splat(self.reach().sum_of_magnitudes());
            let slack = (ray.origin.sum_of_magnitudes() + reach) * L::splat(self.slack);
            (lowest - slack, highest + slack)
        } else {
            (lowest, highest)
        };
        let (from, to) = (lowest / precomputed.along, highest / precomputed.along);
        let t = t.max(from.min(to)).min(from.max(to));
        // A ray parallel to the plane misses, and so does every ray if the triangle has no area.
        L::select(inside & zero.lt(slope.abs()) & zero.lt(t), t, miss())
    }

    /// Returns the rays whose lines cross the triangle, and the positions of its corners along the
    /// dominant axis, from their origins.
    #[inline(always)]
    fn crossed<L: Lane<Scalar = S>>(
        &self,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> (L::Mask, [L; 3]) {
        let zero = L::literal(0.0);
        // Written out, because a `map` over an array is not always inlined.
        let [a, b, c] = self.vertices;
        let (a, b, c) = (precomputed.project(a), precomputed.project(b), precomputed.project(c));
        let edge = |[px, py, _]: [L; 3], [qx, qy, _]: [L; 3]| sign_of_difference(px, qy, py, qx);
        let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
        let front = zero.le(u) & zero.le(v) & zero.le(w);
        let back = u.le(zero) & v.le(zero) & w.le(zero);
        // All three are zero if the ray lies in the triangle's plane.
        let inside = wanted & (front | back) & !(front & back);
        (inside, [a[2], b[2], c[2]])
    }

    /// Returns whether the triangle hides a point on this side of its plane, at the ray's `t = 1`.
    ///
    /// It does if the ray's line crosses it, and its plane separates the ray's ends. The side of
    /// the start is known to `2u sum |n_i (a_i - o_i)|`, which the angle of the ray does not
    /// change. The triangle also has to reach into the part of the dominant axis between the ends,
    /// however little, because a box that does not is skipped.
    #[inline(always)]
    pub(crate) fn hides<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
        side: impl FnOnce() -> Side,
    ) -> L::Mask {
        let zero = L::literal(0.0);
        let (inside, [a, b, c]) = self.crossed(precomputed, wanted);
        if !inside.any() {
            return inside;
        }
        let depth =
            Vector::splat(self.normal).accurate_dot(Vector::splat(self.vertices[0]) - ray.origin);
        let separated = match side() {
            Side::Front => zero.lt(depth),
            Side::Back => depth.lt(zero),
            Side::Unknown => return zero.lt(zero),
        };
        let (lowest, highest) = (a.min(b).min(c), a.max(b).max(c));
        let along = precomputed.along;
        let forward = zero.lt(along);
        let first = L::select(forward, lowest, -highest);
        let last = L::select(forward, highest, -lowest);
        inside & separated & first.le(along.abs()) & zero.lt(last)
    }

    /// Returns the point of the triangle that is closest to `near`.
    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>>(&self, near: Vector<L>) -> SurfacePoint<L> {
        let normal = Vector::splat(self.unit_normal);
        let point = near - normal * normal.dot(near - Vector::splat(self.vertices[0]));
        SurfacePoint {
            point,
            normal,
            offset_bound: offset_bound(normal, point, Vector::splat(self.reach())),
        }
    }
}
