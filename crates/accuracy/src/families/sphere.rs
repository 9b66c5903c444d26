//! Families of spheres.

use glam::DVec3;

use super::Setup;
use super::draw::{Draw, ray, rounded, single};
use crate::cases::{Primitive, Ray};

fn setup(center: DVec3, radius: f64, ray: Ray, note: String) -> Setup {
    Setup {
        primitive: Primitive::Sphere { center: single(center), radius: radius as f32 },
        ray,
        note,
    }
}

pub(super) fn basic(draw: &mut Draw, _: usize) -> Setup {
    let (center, radius) = (draw.within(3.0), draw.range(0.3, 2.0));
    let target = center + draw.unit() * radius * draw.range(0.0, 1.2);
    let origin = draw.within(5.0);
    setup(center, radius, draw.ray_to(origin, target), "control".into())
}

pub(super) fn graze(draw: &mut Draw, _: usize) -> Setup {
    let (center, radius) = (draw.center(5.0), draw.magnitude(0.1, 10.0));
    let excess = draw.signed_magnitude(1e-8, 0.1);
    let along = draw.unit();
    let closest = center + draw.across(along) * radius * (1.0 + excess);
    let origin = closest - along * radius * draw.magnitude(1.5, 1e3);
    setup(center, radius, draw.ray_to(origin, closest), format!("impact/r-1 = {excess:.1e}"))
}

pub(super) fn far(draw: &mut Draw, _: usize) -> Setup {
    let (center, radius) = (draw.center(5.0), draw.magnitude(0.01, 10.0));
    let distance = draw.magnitude(1e2, 1e7);
    let along = draw.unit();
    let target = center + draw.across(along) * radius * draw.range(0.0, 1.15);
    let origin = center - along * radius * distance;
    setup(center, radius, draw.ray_to(origin, target), format!("distance/radius {distance:.1e}"))
}

pub(super) fn ground(draw: &mut Draw, _: usize) -> Setup {
    let radius = f64::from(draw.magnitude(1e5, 1e7) as f32);
    let height = draw.magnitude(0.01, 100.0);
    let mut level = |y: f64| DVec3::new(draw.range(-50.0, 50.0), y, draw.range(-50.0, 50.0));
    let (center, origin) = (level(-radius), level(height));
    let mut direction = draw.unit();
    if draw.chance(0.7) {
        // Down, often at a grazing angle.
        direction.y = -draw.magnitude(0.01, 3.0);
    }
    let note = format!("R {radius:.1e} height {height:.1e}");
    setup(center, radius, ray(origin, direction.normalize()), note)
}

pub(super) fn inside(draw: &mut Draw, _: usize) -> Setup {
    let (center, radius) = (draw.center(5.0), draw.magnitude(0.1, 100.0));
    let origin = center + draw.unit() * radius * libm::cbrt(draw.range(0.0, 0.99));
    let length = if draw.chance(0.5) { 1.0 } else { draw.magnitude(0.1, 10.0) };
    setup(center, radius, ray(origin, draw.unit() * length), "inside".into())
}

pub(super) fn behind(draw: &mut Draw, _: usize) -> Setup {
    let (center, radius) = (draw.center(5.0), draw.magnitude(0.1, 10.0));
    let away = draw.unit();
    let origin = center + away * radius * (1.0 + draw.magnitude(1e-3, 30.0));
    // The added vector is shorter than 0.87, so the direction is outward.
    let direction = away + draw.within(0.5);
    setup(center, radius, ray(origin, direction), "behind the origin".into())
}

pub(super) fn surface_exact(draw: &mut Draw, index: usize) -> Setup {
    let (offset, radius) = loop {
        // Lebesgue's identity: four integers give a vector of integer length.
        let [m, n, p, q] = std::array::from_fn(|_| f64::from(draw.integer(-12, 12)));
        let offset =
            DVec3::new(m * m + n * n - p * p - q * q, 2.0 * (m * q + n * p), 2.0 * (n * q - m * p));
        if offset != DVec3::ZERO {
            break (offset, m * m + n * n + p * p + q * q);
        }
    };
    let unit = libm::ldexp(1.0, draw.integer(-10, 7));
    let center = if draw.chance(0.5) { DVec3::ZERO } else { draw.lattice(1 << 11, unit) };
    let (direction, note) = draw.through_surface(offset, index);
    setup(
        center,
        radius * unit,
        ray(center + offset * unit, direction),
        format!("on the surface, {note}"),
    )
}

pub(super) fn surface_round(draw: &mut Draw, index: usize) -> Setup {
    let (center, radius) = (draw.center(10.0), draw.magnitude(0.01, 1e3));
    let outward = draw.unit();
    let origin = rounded(center + outward * radius);
    let (direction, note) = draw.through_surface(outward, index);
    setup(center, radius, ray(origin, direction), format!("rounded surface point, {note}"))
}
