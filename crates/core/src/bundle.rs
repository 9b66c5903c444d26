//! Rays through one point: all that leave the eye, that a plane mirrors straight from there, or that look at one light.
//!
//! Seen from that point a primitive fills a cone of directions. Whether a ray is outside of the cone is one dot
//! product; only the others are tried. The cones are wider than the primitives by more than the errors of what is
//! tried, so they change no picture.

use crate::lane::{Lane, Scalar};
use crate::scene::{self, Scene};
use crate::shapes::MARGIN;
use crate::vector::Vector;
use glam::DVec3;

/// A cone for each primitive that is not a plane, by kind, in file order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bundle<S> {
    pub(crate) spheres: Vec<Cone<S>>,
    pub(crate) triangles: Vec<Cone<S>>,
    pub(crate) cylinders: Vec<Cone<S>>,
}

/// The directions from the point in which a primitive may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone<S> {
    axis: Vector<S>,
    cosine: S,
    /// What a unit of a ray's length adds: its end is known the less exactly, the farther it is.
    widening: S,
}

impl<S: Scalar> Bundle<S> {
    /// The cones of `scene`'s primitives, seen from `point`.
    pub(crate) fn new(scene: &Scene, point: DVec3) -> Self {
        Self::around(scene, point, 0.0)
    }

    /// The cones as `mirror` shows them to `eye`: what it sends on comes straight from the eye's image behind it, but for
    /// the roundings of a hit, of the ray's start and of its direction.
    pub(crate) fn mirrored(scene: &Scene, eye: DVec3, mirror: &scene::Plane) -> Self {
        let normal = scene::unit(mirror.normal);
        let image = eye - normal * (2.0 * (eye - mirror.point).dot(normal));
        let reach = [eye, image, mirror.point].map(|point| point.abs().max_element());
        Self::around(scene, image, MARGIN * S::ROUNDOFF * reach.iter().sum::<f64>())
    }

    /// The cones around a point that is known up to `uncertainty`.
    fn around(scene: &Scene, point: DVec3, uncertainty: f64) -> Self {
        let cone = |center: DVec3, radius: f64| Cone::new(point, center, radius + uncertainty);
        Self {
            spheres: scene.spheres.iter().map(|s| cone(s.center, s.radius)).collect(),
            triangles: (scene.triangles.iter())
                .map(|triangle| {
                    let [a, b, c] = triangle.vertices;
                    let middle = (a.min(b).min(c) + a.max(b).max(c)) / 2.0;
                    cone(middle, [a, b, c].map(|v| v.distance(middle)).into_iter().fold(0.0, f64::max))
                })
                .collect(),
            cylinders: (scene.cylinders.iter())
                .map(|c| cone((c.bottom + c.top) / 2.0, c.radius.hypot((c.top.y - c.bottom.y) / 2.0)))
                .collect(),
        }
    }
}

impl<S: Scalar> Cone<S> {
    fn new(point: DVec3, center: DVec3, radius: f64) -> Self {
        let unit = MARGIN * S::ROUNDOFF;
        let toward = center - point;
        let distance = toward.length();
        let reach = center.abs().max_element() + point.abs().max_element() + radius;
        let sine = (radius + unit * reach) / distance;
        // Too near, or numbers that are none: every direction.
        if !(sine < 0.99 && distance.is_normal()) {
            let everything = S::from_f64(-4.0);
            return Self { axis: Vector::zero(), cosine: everything, widening: S::literal(0.0) };
        }
        Self {
            axis: Vector::rounded(toward / distance),
            cosine: S::from_f64((1.0 - sine * sine).sqrt() - unit),
            widening: S::from_f64(2.0 * unit / distance),
        }
    }

    /// The rays that may meet the primitive: of unit `direction` away from the point, and `length` long.
    #[inline(always)]
    pub(crate) fn may_meet<L: Lane<Scalar = S>>(&self, direction: Vector<L>, length: L) -> L::Mask {
        let cosine = Vector::splat(self.axis).dot(direction) + L::splat(self.widening) * length;
        // Asked this way, numbers that are none rule nothing out.
        !cosine.lt(L::splat(self.cosine))
    }
}
