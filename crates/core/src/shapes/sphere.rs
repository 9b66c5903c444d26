//! The sphere.

use super::aabb::Aabb;
use super::quadric::Center;
use super::{SurfacePoint, offset_bound, quadric};
use crate::ray::{Ray, miss};
use crate::scene;
use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;

/// A sphere in the precision of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere<S> {
    pub(crate) center: Vector<S>,
    pub(crate) radius: S,
    radius_squared: S,
}

/// The part of the formulas that depends on the ray alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayPrecomputation<L> {
    inverse_square: L,
}

impl<L: Lane> RayPrecomputation<L> {
    /// Returns a placeholder, for scenes without spheres.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { inverse_square: L::literal(0.0) }
    }

    #[inline(always)]
    pub(crate) fn new(ray: &Ray<L>) -> Self {
        Self { inverse_square: L::literal(1.0) / ray.direction.dot(ray.direction) }
    }
}

impl<S: Scalar> Sphere<S> {
    pub(crate) fn new(sphere: &scene::Sphere) -> Self {
        let radius = S::from_f64(sphere.radius);
        Self { center: Vector::rounded(sphere.center), radius, radius_squared: radius * radius }
    }

    /// Returns the box around it.
    pub(crate) fn bounds(&self) -> Aabb<S> {
        let reach = Vector::new(self.radius, self.radius, self.radius);
        Aabb::new(self.center - reach, self.center + reach)
    }

    /// Returns the smaller of the [roots](quadric::roots) above 0.
    ///
    /// For a ray from 0, the point closest to the centre `c` is found to about `8u |c|`, and so the
    /// discriminant to about `16u |c| / r` of `r^2`. In `b^2 - 4ac` it would be `8u (|c| / r)^2`:
    /// for a sphere 4,000 radii away no digit would be left in `f32`.
    #[inline(always)]
    pub(crate) fn intersect<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        let zero = L::literal(0.0);
        let radius_squared = L::splat(self.radius_squared);
        let to_center = Vector::splat(self.center) - ray.origin;
        let closest = to_center.dot(ray.direction) * precomputed.inverse_square;
        let perpendicular = to_center - ray.direction * closest;
        let discriminant = radius_squared - perpendicular.dot(perpendicular);
        let crossed = wanted & zero.le(discriminant);
        if !crossed.any() {
            return miss();
        }
        // The remaining component along the ray is the error of `closest`, which is corrected at
        // little cost.
        let closest = closest + perpendicular.dot(ray.direction) * precomputed.inverse_square;
        let power = to_center.dot(to_center) - radius_squared;
        // The sphere is behind a ray that starts outside of it: both roots are below 0.
        let crossed = crossed & !(closest.lt(zero) & zero.lt(power));
        if !crossed.any() {
            return miss();
        }
        let (near, far) = quadric::roots(closest, discriminant, power, precomputed.inverse_square);
        let t = L::select(zero.lt(near), near, far);
        L::select(crossed & zero.lt(t), t, miss())
    }

    /// Returns whether the sphere hides the light at the ray's `t = 1`. The light is outside of it
    /// and not [near](Center) it. So both roots lie before the light if their middle does, and the
    /// start of the ray decides as in [`intersect`](Self::intersect).
    #[inline(always)]
    pub(crate) fn hides<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L::Mask {
        let (zero, one) = (L::literal(0.0), L::literal(1.0));
        let radius_squared = L::splat(self.radius_squared);
        let to_center = Vector::splat(self.center) - ray.origin;
        let closest = to_center.dot(ray.direction) * precomputed.inverse_square;
        let perpendicular = to_center - ray.direction * closest;
        let discriminant = radius_squared - perpendicular.dot(perpendicular);
        let crossed = wanted & zero.le(discriminant);
        if !crossed.any() {
            return crossed;
        }
        let closest = closest + perpendicular.dot(ray.direction) * precomputed.inverse_square;
        let power = to_center.dot(to_center) - radius_squared;
        crossed & closest.lt(one) & (zero.lt(closest) | power.lt(zero))
    }

    /// Returns whether the sphere hides the light that it is near, at the ray's `t = 1`.
    ///
    /// From inside it hides a light outside, and from outside a light inside. From outside it
    /// hides a light outside, or on it, if the ray comes out of the sphere before the light: with
    /// `l` from the centre to the light, that is `g = l . d > 0` and `g^2 >= power d^2`. Both sides
    /// are known to a few roundings of their own size, because `power` was computed in `f64`. On
    /// the sphere it is 0. There the angle between ray and surface decides alone, up to
    /// `3u sum |l_i d_i|` and the rounding of `d`.
    #[inline(always)]
    pub(crate) fn hides_near<L: Lane<Scalar = S>>(&self, ray: &Ray<L>, at: &Center<S>) -> L::Mask {
        let zero = L::literal(0.0);
        let to_center = Vector::splat(self.center) - ray.origin;
        let start_power = to_center.dot(to_center) - L::splat(self.radius_squared);
        if at.power.lt(S::literal(0.0)) {
            return zero.lt(start_power);
        }
        let power = L::splat(at.power);
        let leaving = Vector::splat(at.light).dot(ray.direction);
        let through = zero.le(start_power)
            & zero.lt(to_center.dot(ray.direction))
            & zero.lt(leaving)
            & (power * ray.direction.dot(ray.direction)).le(leaving * leaving);
        through | (zero.lt(power) & start_power.lt(zero))
    }

    /// Returns the point of the sphere that is closest to `near`.
    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>>(&self, near: Vector<L>) -> SurfacePoint<L> {
        let (center, radius) = (Vector::splat(self.center), L::splat(self.radius));
        let normal = (near - center).unit();
        let point = center + normal * radius;
        let reach = center.abs() + Vector::new(radius, radius, radius);
        SurfacePoint { point, normal, offset_bound: offset_bound(normal, point, reach) }
    }
}
