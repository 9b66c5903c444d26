//! The open cylinder around a vertical axis: a circle in x and z, bounded in y.

use super::aabb::Aabb;
use super::quadric::Center;
use super::{SurfacePoint, offset_bound, quadric};
use crate::ray::{Ray, miss};
use crate::scene;
use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;

/// A cylinder in the precision of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder<S> {
    /// The lower end of the axis.
    pub(crate) bottom: Vector<S>,
    /// The y of the upper end.
    pub(crate) top: S,
    pub(crate) radius: S,
    radius_squared: S,
}

/// The part of the formulas that depends on the ray alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayPrecomputation<L> {
    /// One over the squared length of the direction's part across the axis. It is infinite for a
    /// ray along the axis, which then gets NaN and so misses.
    inverse_square: L,
}

impl<L: Lane> RayPrecomputation<L> {
    /// Returns a placeholder, for scenes without cylinders.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { inverse_square: L::literal(0.0) }
    }

    #[inline(always)]
    pub(crate) fn new(ray: &Ray<L>) -> Self {
        let Vector { x, z, .. } = ray.direction;
        Self { inverse_square: L::literal(1.0) / (x * x + z * z) }
    }
}

impl<S: Scalar> Cylinder<S> {
    pub(crate) fn new(cylinder: &scene::Cylinder) -> Self {
        let radius = S::from_f64(cylinder.radius);
        Self {
            bottom: Vector::rounded(cylinder.bottom),
            top: S::from_f64(cylinder.top.y),
            radius,
            radius_squared: radius * radius,
        }
    }

    /// Returns the box around it.
    pub(crate) fn bounds(&self) -> Aabb<S> {
        let across = Vector::new(self.radius, S::literal(0.0), self.radius);
        let top = Vector { y: self.top, ..self.bottom };
        Aabb::new(self.bottom - across, top + across)
    }

    /// Returns the smaller of the [roots](quadric::roots) above 0 that are on the wall. Both roots
    /// are tried, because the far wall is visible through the open end. The discriminant has the
    /// error of a sphere's, in x and z.
    #[inline(always)]
    pub(crate) fn intersect<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L {
        let (near, far, _) = self.roots(ray, precomputed, wanted);
        L::select(near.lt(miss()), near, far)
    }

    /// Returns the two [roots](quadric::roots) where they are above 0 and on the wall, or else a
    /// miss, and their middle.
    #[inline(always)]
    fn roots<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> (L, L, L) {
        let zero = L::literal(0.0);
        let radius_squared = L::splat(self.radius_squared);
        let Vector { x: dx, y: dy, z: dz } = ray.direction;
        let (cx, cz) =
            (L::splat(self.bottom.x) - ray.origin.x, L::splat(self.bottom.z) - ray.origin.z);
        let closest = (cx * dx + cz * dz) * precomputed.inverse_square;
        let (ax, az) = (cx - dx * closest, cz - dz * closest);
        let discriminant = radius_squared - (ax * ax + az * az);
        let crossed = wanted & zero.le(discriminant);
        if !crossed.any() {
            return (miss(), miss(), closest);
        }
        let closest = closest + (ax * dx + az * dz) * precomputed.inverse_square;
        let power = (cx * cx + cz * cz) - radius_squared;
        // The cylinder is behind a ray that starts outside of it: both roots are below 0.
        let crossed = crossed & !(closest.lt(zero) & zero.lt(power));
        if !crossed.any() {
            return (miss(), miss(), closest);
        }
        let (near, far) = quadric::roots(closest, discriminant, power, precomputed.inverse_square);
        let on_wall = |t: L| L::select(crossed & self.on_wall(ray.origin.y, dy, t), t, miss());
        (on_wall(near), on_wall(far), closest)
    }

    /// Returns whether the point at `t` of a ray is on the wall, at `t > 0`, given the ray's y.
    /// Differences of coordinates come first, so that a scene far from the origin loses nothing.
    #[inline(always)]
    fn on_wall<L: Lane<Scalar = S>>(&self, from: L, direction: L, t: L) -> L::Mask {
        let (to_bottom, to_top) = (L::splat(self.bottom.y) - from, L::splat(self.top) - from);
        let climb = direction * t;
        L::literal(0.0).lt(t) & to_bottom.le(climb) & climb.le(to_top)
    }

    /// Returns whether the wall hides the light at the ray's `t = 1`. The light is farther from the
    /// axis than the wall and not [near](Center) it. So both roots lie before the light if their
    /// middle does.
    #[inline(always)]
    pub(crate) fn hides<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        wanted: L::Mask,
    ) -> L::Mask {
        let (near, far, middle) = self.roots(ray, precomputed, wanted);
        middle.lt(L::literal(1.0)) & (near.lt(miss()) | far.lt(miss()))
    }

    /// Returns whether the wall hides the `light` that it is near, at the ray's `t = 1`.
    ///
    /// The roots are those of the ray back from the light, so that a wall through the light has one
    /// at 0, exactly. The sides of both ends, across the axis, tell which roots lie between them.
    #[inline(always)]
    pub(crate) fn hides_near<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        precomputed: &RayPrecomputation<L>,
        (light, at): (Vector<S>, &Center<S>),
    ) -> L::Mask {
        let zero = L::literal(0.0);
        let Vector { x: dx, y: dy, z: dz } = ray.direction;
        let (cx, cz) =
            (L::splat(self.bottom.x) - ray.origin.x, L::splat(self.bottom.z) - ray.origin.z);
        let start_power = (cx * cx + cz * cz) - L::splat(self.radius_squared);
        let inverse_square = precomputed.inverse_square;
        let power = L::splat(at.power);
        let leaving = L::splat(at.light.x) * dx + L::splat(at.light.z) * dz;
        let closest = leaving * inverse_square;
        let (near, far) = quadric::roots(closest, leaving * closest - power, power, inverse_square);
        let on_wall = |t: L| self.on_wall(L::splat(light.y), -dy, t);
        if at.power.lt(S::literal(0.0)) {
            return zero.lt(start_power) & on_wall(far);
        }
        let through =
            zero.le(start_power) & zero.lt(cx * dx + cz * dz) & (on_wall(near) | on_wall(far));
        through | (zero.lt(power) & start_power.lt(zero) & on_wall(near))
    }

    /// Returns the point of the cylinder that is closest to `near`.
    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>>(&self, near: Vector<L>) -> SurfacePoint<L> {
        let zero = L::literal(0.0);
        let (bottom, radius) = (Vector::splat(self.bottom), L::splat(self.radius));
        let normal = Vector::new(near.x - bottom.x, zero, near.z - bottom.z).unit();
        let on_axis = Vector::new(bottom.x, near.y, bottom.z);
        let point = on_axis + normal * radius;
        let reach = bottom.abs() + Vector::new(radius, zero, radius);
        SurfacePoint { point, normal, offset_bound: offset_bound(normal, point, reach) }
    }
}
