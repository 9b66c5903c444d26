//! Families of planes.

use glam::DVec3;

use super::Setup;
use super::draw::{Draw, ray, single};
use crate::cases::{Primitive, Ray};

fn setup(point: DVec3, normal: DVec3, ray: Ray, note: String) -> Setup {
    Setup {
        primitive: Primitive::Plane { point: single(point), normal: single(normal) },
        ray,
        note,
    }
}

/// Draws the normal of a floor in some cases, else any normal.
fn normal(draw: &mut Draw) -> DVec3 {
    if draw.chance(0.4) { DVec3::Y } else { draw.unit() }
}

pub(super) fn basic(draw: &mut Draw, _: usize) -> Setup {
    let (point, normal) = (draw.within(3.0), draw.unit());
    setup(point, normal, ray(draw.within(5.0), draw.unit()), "control".into())
}

pub(super) fn parallel(draw: &mut Draw, _: usize) -> Setup {
    let (point, normal) = (draw.within(3.0), normal(draw));
    let angle = draw.signed_magnitude(1e-7, 0.1);
    let direction = (draw.across(normal) + normal * angle).normalize();
    let origin = point + draw.unit() * draw.range(0.3, 6.0);
    setup(point, normal, ray(origin, direction), format!("angle {:.1e}", angle.abs()))
}

pub(super) fn far(draw: &mut Draw, _: usize) -> Setup {
    let distance = draw.magnitude(1e2, 1e7);
    let (origin, normal) = (draw.within(5.0), normal(draw));
    let sideways = draw.across(normal) * draw.range(0.0, 1.0);
    let point = origin + (normal * draw.sign() + sideways) * distance;
    setup(point, normal, ray(origin, draw.unit()), format!("distance {distance:.1e}"))
}
