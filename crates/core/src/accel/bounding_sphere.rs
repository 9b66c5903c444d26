//! Bounding spheres of triangles: they rule out rays cheaply.
//!
//! Trying a triangle takes rays that are grouped by their dominant axis. Rays that come near no
//! triangle need not be grouped.

use crate::ray::Ray;
use crate::scene;
use crate::shapes::MARGIN;
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

/// A sphere that holds a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundingSphere<S> {
    center: Vector<S>,
    radius: S,
    /// The largest magnitude of a coordinate of the sphere.
    reach: S,
}

/// The smallest radius whose square no number type loses.
const SMALLEST: f64 = 1e-15;

impl<S: Scalar> BoundingSphere<S> {
    /// Makes a sphere around `triangle`.
    pub(crate) fn new(triangle: &scene::Triangle) -> Self {
        let (center, radius) = triangle.around();
        let radius = radius.max(SMALLEST);
        Self {
            center: Vector::rounded(center),
            radius: S::from_f64(radius),
            reach: S::from_f64(center.abs().max_element() + radius),
        }
    }

    /// Returns the rays whose whole line comes near the triangle, for rays of unit direction. The
    /// distance from the centre is known to 17 roundings of the coordinates. The rest of the margin
    /// covers the error of a hit, barring underflow.
    #[inline(always)]
    pub(crate) fn may_hit<L: Lane<Scalar = S>>(&self, ray: &Ray<L>) -> L::Mask {
        let Vector { x, y, z } = ray.origin.abs();
        let farthest = x.max(y).max(z);
        let margin = (farthest + L::splat(self.reach)) * L::literal(MARGIN * S::ROUNDOFF);
        let radius = L::splat(self.radius) + margin;
        let aside = (Vector::splat(self.center) - ray.origin).cross(ray.direction);
        let square = aside.dot(aside);
        // In this form, NaN and overflow rule nothing out.
        !((radius * radius).lt(square) & square.lt(L::literal(f64::INFINITY)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::random_points;
    use crate::ray::miss;
    use crate::shapes::triangle::{RayPrecomputation, Triangle};

    /// Catches a hit that is ruled out: rays graze the sphere where a corner of the triangle
    /// touches it. Catches a sphere that is too large: rays that pass a tenth of the radius farther
    /// out are ruled out.
    fn grazing_rays_are_told_apart<S: Scalar>() {
        let mut point = random_points();
        let mut hits = 0;
        for i in 0..10_000 {
            let size = [1e-3, 0.1, 10.0][i % 3];
            let offset = point() * [0.0, 1e3][i % 2];
            let vertices = [point(), point(), point()].map(|v| offset + v * size);
            let triangle = scene::Triangle { vertices, material: 0 };
            let (center, radius) = triangle.around();
            let aside = |v: &glam::DVec3| (*v - center).length();
            let corner = vertices
                .into_iter()
                .max_by(|a, b| aside(a).total_cmp(&aside(b)))
                .unwrap_or_default();
            let outward = (corner - center).normalize();
            let along = outward.cross(point() - 0.5).normalize();
            let ray = |target: glam::DVec3| Ray::<S> {
                origin: Vector::rounded(target - along * size * [0.1, 10.0, 1e3][i / 6 % 3]),
                direction: Vector::<S>::rounded(along).unit(),
            };

            let grazing = ray(corner);
            grazing.by_axis(true, |order, _| {
                let t = Triangle::<S>::new(&triangle).intersect(
                    &grazing,
                    &RayPrecomputation::new(&grazing, order),
                    true,
                );
                let hit = t.lt(miss());
                assert!(
                    !hit || BoundingSphere::<S>::new(&triangle).may_hit(&grazing),
                    "{triangle:?} {grazing:?}"
                );
                hits += usize::from(hit);
            });
            let roundings = 1e3 * S::ROUNDOFF * (corner.abs().max_element() + 1e3 * size);
            let outside = ray(corner + outward * (0.1 * radius + roundings));
            assert!(
                !BoundingSphere::<S>::new(&triangle).may_hit(&outside),
                "{triangle:?} {outside:?}"
            );
        }
        assert!(hits > 500, "{hits}");
    }

    #[test]
    fn grazing_rays_are_told_apart_in_both_precisions() {
        grazing_rays_are_told_apart::<f32>();
        grazing_rays_are_told_apart::<f64>();
    }
}
