//! The triangle, its edges included, without gaps to its neighbours.

use super::{SurfacePoint, clearance};
use crate::lane::{Lane, Mask, Scalar, sign_of_difference};
use crate::ray::{Ray, miss};
use crate::scene;
use crate::vector::Vector;
use glam::DVec3;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle<S> {
    pub(crate) vertices: [Vector<S>; 3],
    /// Of a length near 1, but not made unit, which would cost digits; or zero when rounding took the
    /// triangle's area: then no ray hits it.
    pub(crate) normal: Vector<S>,
    unit_normal: Vector<S>,
    /// The largest magnitude of each coordinate.
    reach: Vector<S>,
}

/// The axis along which a ray's direction is longest: x, y or z for 0, 1 or 2.
pub(crate) const AXES: usize = 3;

/// What all triangles ask of a ray whose direction is longest along `AXIS`: the shear that turns
/// the ray into that axis. Triangles are then tested in the two other coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Aim<L, const AXIS: usize> {
    shear: [L; 2],
    /// The direction's component along the axis.
    along: L,
}

/// For each axis, the mask of rays that are longest along it; every ray belongs to exactly one.
#[inline(always)]
pub(crate) fn longest_axis<L: Lane>(direction: Vector<L>) -> [L::Mask; AXES] {
    let Vector { x, y, z } = direction.abs();
    let is_x = y.lt(x) & z.lt(x);
    let is_y = !is_x & z.lt(y);
    [is_x, is_y, !is_x & !is_y]
}

/// The coordinates of `v`, that along `AXIS` last.
#[inline(always)]
fn turned<L: Lane, const AXIS: usize>(v: Vector<L>) -> [L; 3] {
    match AXIS {
        0 => [v.y, v.z, v.x],
        1 => [v.z, v.x, v.y],
        _ => [v.x, v.y, v.z],
    }
}

impl<L: Lane, const AXIS: usize> Aim<L, AXIS> {
    #[inline(always)]
    pub(crate) fn new(ray: &Ray<L>) -> Self {
        let [x, y, z] = turned::<L, AXIS>(ray.direction);
        Self { shear: [x / z, y / z], along: z }
    }

    /// Where `v` lies aside of the ray, and how far along the axis. The same rounded point for every
    /// triangle that shares `v`.
    #[inline(always)]
    fn project(&self, ray: &Ray<L>, v: Vector<L>) -> [L; 3] {
        let [x, y, z] = turned::<L, AXIS>(v - ray.origin);
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }
}

impl<S: Scalar> Triangle<S> {
    pub(crate) fn new(triangle: &scene::Triangle) -> Self {
        // The plane of the rounded corners: those of the scene may lie on another.
        let vertices = triangle.vertices.map(Vector::rounded);
        let [a, b, c] = vertices.map(Vector::widened);
        let normal = if scene::parallel(b - a, c - a) {
            DVec3::ZERO
        } else {
            scene::near_one(scene::near_one(b - a).cross(scene::near_one(c - a)))
        };
        let unit_normal = normal.normalize_or_zero();
        let [normal, unit_normal] = [normal, unit_normal].map(Vector::rounded);
        Self { vertices, normal, unit_normal, reach: Vector::rounded(a.abs().max(b.abs()).max(c.abs())) }
    }

    /// The edge test of Woop, Benthin and Wald (Watertight Ray/Triangle Intersection, JCGT 2013):
    /// signs of 2 x 2 determinants of projected corners, which are the same from both sides of a
    /// shared edge. `t` is that of the plane, differences first, its sums in twice the digits, since few
    /// rays come that far; where the ray grazes the plane it is mostly noise all the same, so it is kept
    /// between those of the corners.
    ///
    /// The corners are projected to within `3u` of their coordinates, and then every sign is exact. Relative
    /// error of `t` in `f32`, whose corners `f64` turns into a normal without a loss: at most `2u sum |n_i (a_i - o_i)| / |n . (a - o)| + u sum |n_i d_i| / |n . d| + 3u`: the
    /// rounded normal and differences, then two sums and a quotient rounded once.
    #[inline(always)]
    pub(crate) fn intersect<L: Lane<Scalar = S>, const AXIS: usize>(
        &self,
        ray: &Ray<L>,
        aim: &Aim<L, AXIS>,
    ) -> L {
        let zero = L::literal(0.0);
        let [a, b, c] = self.vertices.map(|v| aim.project(ray, Vector::splat(v)));
        let edge = |[px, py, _]: [L; 3], [qx, qy, _]: [L; 3]| sign_of_difference(px, qy, py, qx);
        let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
        let front = zero.le(u) & zero.le(v) & zero.le(w);
        let back = u.le(zero) & v.le(zero) & w.le(zero);
        // All three zero: the ray lies in the triangle's plane.
        let inside = (front | back) & !(front & back);
        if !inside.any() {
            return miss();
        }
        let normal = Vector::splat(self.normal);
        let slope = normal.accurate_dot(ray.direction);
        let t = normal.accurate_dot(Vector::splat(self.vertices[0]) - ray.origin) / slope;
        let (lowest, highest) = (a[2].min(b[2]).min(c[2]), a[2].max(b[2]).max(c[2]));
        let (from, to) = (lowest / aim.along, highest / aim.along);
        let t = t.max(from.min(to)).min(from.max(to));
        // A ray parallel to the plane, or a triangle without area, misses.
        L::select(inside & zero.lt(slope.abs()) & zero.lt(t), t, miss())
    }

    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>>(&self, near: Vector<L>) -> SurfacePoint<L> {
        let normal = Vector::splat(self.unit_normal);
        let point = near - normal * normal.dot(near - Vector::splat(self.vertices[0]));
        SurfacePoint { point, normal, clearance: clearance(normal, point, Vector::splat(self.reach)) }
    }
}
