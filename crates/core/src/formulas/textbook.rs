//! The formulas of the lab report with its errors corrected: to compare their time and their error.

use super::family::{Family, LightPath};
use crate::ray::{Ray, miss};
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::side::Side;
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle};
use crate::simd::lane::{Lane, Mask};
use crate::simd::vector::Vector;

/// The family of [`Formulas::Textbook`](crate::Formulas::Textbook).
#[derive(Debug)]
pub(crate) struct Textbook;

/// The lab report's constant: a closer hit is taken for the surface that the ray comes from. It is
/// a length in scene units, so it suits scenes of one scale only.
const OFFSET: f64 = 1e-3;

impl Family for Textbook {
    const ERROR_BOUNDED: bool = false;

    #[inline(always)]
    fn plane<L: Lane>(plane: &Plane<L::Scalar>, ray: &Ray<L>) -> L {
        let t = plane_root(Vector::splat(plane.point), Vector::splat(plane.normal), ray);
        L::select(beyond_offset(t), t, miss())
    }

    #[inline(always)]
    fn sphere<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        _precomputed: &sphere::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        let from_center = ray.origin - Vector::splat(sphere.center);
        let a = ray.direction.dot(ray.direction);
        let b = L::literal(2.0) * from_center.dot(ray.direction);
        let c = from_center.dot(from_center) - L::splat(sphere.radius * sphere.radius);
        first_root(a, b, c, wanted, beyond_offset)
    }

    /// Intersects the plane, then tests on which side of each edge the point lies, with three cross
    /// products.
    ///
    /// The point is off by some `4u` of its coordinates and `t |d|`, differently for each triangle.
    /// So a point on an edge that two triangles share may belong to neither.
    #[inline(always)]
    fn triangle<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        _precomputed: &triangle::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        let [a, b, c] = triangle.vertices.map(Vector::splat);
        let normal = Vector::splat(triangle.normal);
        let t = plane_root(a, normal, ray);
        let beyond = wanted & beyond_offset(t);
        if !beyond.any() {
            return miss();
        }
        let point = ray.at(t);
        let within = |from: Vector<L>, to: Vector<L>| {
            L::literal(0.0).le(normal.dot((to - from).cross(point - from)))
        };
        L::select(beyond & within(a, b) & within(b, c) & within(c, a), t, miss())
    }

    #[inline(always)]
    fn cylinder<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        _precomputed: &cylinder::RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        let (bottom, top) = (Vector::splat(cylinder.bottom), L::splat(cylinder.top));
        let (x, z) = (ray.origin.x - bottom.x, ray.origin.z - bottom.z);
        let Vector { x: dx, y: dy, z: dz } = ray.direction;
        let a = dx * dx + dz * dz;
        let b = L::literal(2.0) * (x * dx + z * dz);
        let c = x * x + z * z - L::splat(cylinder.radius * cylinder.radius);
        let on_wall = |t: L| {
            let y = ray.origin.y + dy * t;
            beyond_offset(t) & bottom.y.le(y) & y.le(top)
        };
        first_root(a, b, c, wanted, on_wall)
    }

    /// Keeps the hit where `t` says, and lets rays leave from there.
    #[inline(always)]
    fn snap_to_surface<L: Lane>(near: Vector<L>, on_surface: SurfacePoint<L>) -> SurfacePoint<L> {
        SurfacePoint { point: near, offset_bound: L::literal(0.0), ..on_surface }
    }

    #[inline(always)]
    fn shadow_ray<L: Lane>(path: &LightPath<L>) -> (Ray<L>, L) {
        (Ray { origin: path.start, direction: path.to_light }, path.distance - L::literal(OFFSET))
    }

    #[inline(always)]
    fn plane_hides<L: Lane>(
        plane: &Plane<L::Scalar>,
        ray: &Ray<L>,
        limit: L,
        _side: Side,
    ) -> L::Mask {
        Self::plane(plane, ray).lt(limit)
    }

    #[inline(always)]
    fn sphere_hides<L: Lane>(
        sphere: &Sphere<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &sphere::RayPrecomputation<L>,
        wanted: L::Mask,
        limit: L,
    ) -> L::Mask {
        Self::sphere(sphere, ray, precomputed, wanted).lt(limit)
    }

    #[inline(always)]
    fn triangle_hides<L: Lane>(
        triangle: &Triangle<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &triangle::RayPrecomputation<L>,
        wanted: L::Mask,
        limit: L,
        _side: impl FnOnce() -> Side,
    ) -> L::Mask {
        Self::triangle(triangle, ray, precomputed, wanted).lt(limit)
    }

    #[inline(always)]
    fn cylinder_hides<L: Lane>(
        cylinder: &Cylinder<L::Scalar>,
        ray: &Ray<L>,
        precomputed: &cylinder::RayPrecomputation<L>,
        wanted: L::Mask,
        limit: L,
    ) -> L::Mask {
        Self::cylinder(cylinder, ray, precomputed, wanted).lt(limit)
    }
}

#[inline(always)]
fn beyond_offset<L: Lane>(t: L) -> L::Mask {
    L::literal(OFFSET).lt(t)
}

#[inline(always)]
fn plane_root<L: Lane>(point: Vector<L>, normal: Vector<L>, ray: &Ray<L>) -> L {
    normal.dot(point - ray.origin) / normal.dot(ray.direction)
}

/// Returns the smaller of the roots of `a t^2 + b t + c` that counts.
///
/// The discriminant cancels: its error is about `8u b^2`, which may be all of it, and all of the
/// root. A ray along a cylinder's axis has `a = 0`, and roots that are NaN or infinite.
#[inline(always)]
fn first_root<L: Lane>(a: L, b: L, c: L, wanted: L::Mask, counts: impl Fn(L) -> L::Mask) -> L {
    let discriminant = b * b - L::literal(4.0) * a * c;
    let real = wanted & L::literal(0.0).le(discriminant);
    if !real.any() {
        return miss();
    }
    let (root, twice_a) = (discriminant.sqrt(), L::literal(2.0) * a);
    let (near, far) = ((-b - root) / twice_a, (-b + root) / twice_a);
    let t = L::select(counts(near), near, L::select(counts(far), far, miss()));
    L::select(real, t, miss())
}
