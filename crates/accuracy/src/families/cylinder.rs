//! Families of cylinders.

use glam::{DVec2, DVec3};

use super::Setup;
use super::draw::{Draw, ray, rounded, single};
use crate::cases::{Primitive, Ray};

/// The wall of a cylinder, with numbers rounded to f32.
struct Wall {
    bottom: DVec3,
    height: f64,
    radius: f64,
}

impl Wall {
    fn new(bottom: DVec3, height: f64, radius: f64) -> Self {
        Self { bottom: rounded(bottom), height, radius: f64::from(radius as f32) }
    }

    /// Returns a point, given its direction from the axis, its distance in radii and its height in
    /// heights.
    fn at(&self, outward: DVec2, radii: f64, heights: f64) -> DVec3 {
        self.bottom + spread(outward * radii * self.radius, heights * self.height)
    }

    fn setup(&self, ray: Ray, note: String) -> Setup {
        let top = self.bottom + DVec3::Y * self.height;
        let (bottom, top) = (single(self.bottom), single(top));
        Setup {
            primitive: Primitive::Cylinder { bottom, top, radius: self.radius as f32 },
            ray,
            note,
        }
    }
}

/// Combines the horizontal part of a vector, in x and z, with its height.
fn spread(flat: DVec2, y: f64) -> DVec3 {
    DVec3::new(flat.x, y, flat.y)
}

/// Draws a wall of ordinary proportions: radius 0.3 to 2, height 0.5 to 4.
fn ordinary(draw: &mut Draw, bottom: DVec3) -> Wall {
    Wall::new(bottom, draw.range(0.5, 4.0), draw.range(0.3, 2.0))
}

pub(super) fn basic(draw: &mut Draw, _: usize) -> Setup {
    let bottom = draw.within(3.0);
    let wall = ordinary(draw, bottom);
    let target = wall.at(draw.circle(), draw.range(0.0, 1.1), draw.range(-0.1, 1.1));
    let origin = draw.within(5.0);
    wall.setup(draw.ray_to(origin, target), "control".into())
}

pub(super) fn parallel(draw: &mut Draw, _: usize) -> Setup {
    let tilt = if draw.chance(0.1) { 0.0 } else { draw.magnitude(1e-12, 0.1) };
    let (bottom, radius, way) = (draw.center(5.0), draw.range(0.3, 2.0), draw.sign());
    let (wall, radii, start) = if tilt > 3e-6 {
        // The wall is tall enough for the ray to meet it.
        (
            Wall::new(bottom, draw.range(3.0, 10.0) * radius / tilt, radius),
            draw.range(0.0, 0.95),
            0.02,
        )
    } else {
        (
            Wall::new(bottom, draw.range(1.0, 5.0), radius),
            draw.range(0.0, 1.4),
            draw.range(-0.2, 1.2),
        )
    };
    let origin = wall.at(draw.circle(), radii, if way > 0.0 { start } else { 1.0 - start });
    wall.setup(ray(origin, spread(draw.circle() * tilt, way)), format!("tilt {tilt:.1e}"))
}

pub(super) fn graze(draw: &mut Draw, _: usize) -> Setup {
    let (bottom, radius) = (draw.center(5.0), draw.magnitude(0.1, 10.0));
    let excess = draw.signed_magnitude(1e-8, 0.1);
    let distance = radius * draw.magnitude(1.5, 1e3);
    let wall = Wall::new(bottom, distance, radius);
    let outward = draw.circle();
    let closest = wall.at(outward, 1.0 + excess, draw.range(0.3, 0.7));
    let rise = draw.range(-0.2, 0.2) * distance;
    let origin = closest + spread(outward.perp() * draw.sign() * distance, rise);
    wall.setup(draw.ray_to(origin, closest), format!("impact/r-1 = {excess:.1e}"))
}

pub(super) fn rim(draw: &mut Draw, _: usize) -> Setup {
    let bottom = draw.center(5.0);
    let wall = ordinary(draw, bottom);
    let beyond = draw.signed_magnitude(1e-7, 0.1);
    let (rim, name) = if draw.chance(0.5) { (1.0, "top") } else { (0.0, "bottom") };
    let outward = draw.circle();
    let target = wall.at(outward, 1.0, rim + beyond);
    let sideways = outward.perp() * draw.range(-0.5, 0.5);
    let origin =
        target + spread((outward + sideways) * draw.range(0.6, 4.0), draw.range(-4.0, 4.0));
    wall.setup(draw.ray_to(origin, target), format!("{name} rim {beyond:.1e} h"))
}

pub(super) fn far_wall(draw: &mut Draw, _: usize) -> Setup {
    let bottom = draw.center(5.0);
    let wall = ordinary(draw, bottom);
    let outside = draw.magnitude(1e-4, 1.0);
    let outward = draw.circle();
    let (near_height, far_height) = (-outside, draw.range(0.1, 0.9));
    let turned =
        if draw.chance(0.5) { [near_height, far_height] } else { [1.0 - near_height, far_height] };
    let near = wall.at(outward, 1.0, turned[0]);
    let opposite = (outward.perp() * draw.range(-0.8, 0.8) - outward).normalize();
    let far = wall.at(opposite, 1.0, turned[1]);
    let origin = near + (near - far).normalize() * draw.range(0.3, 6.0);
    wall.setup(draw.ray_to(origin, far), format!("near root {outside:.1e} h outside"))
}

pub(super) fn inside(draw: &mut Draw, _: usize) -> Setup {
    let (bottom, radius) = (draw.center(5.0), draw.magnitude(0.1, 10.0));
    let wall = Wall::new(bottom, draw.magnitude(0.3, 10.0), radius);
    let origin = wall.at(draw.circle(), draw.range(0.0, 0.99).sqrt(), draw.range(0.0, 1.0));
    let length = if draw.chance(0.5) { 1.0 } else { 3.0 };
    wall.setup(ray(origin, draw.unit() * length), "inside".into())
}

pub(super) fn huge(draw: &mut Draw, _: usize) -> Setup {
    let (radius, height) = (draw.magnitude(1e3, 1e6), draw.magnitude(0.1, 10.0));
    let center = draw.within(5.0);
    let wall = Wall::new(spread(center.truncate(), 0.0), height, radius);
    let inside = draw.chance(0.7);
    let gap = draw.magnitude(0.1, if inside { radius } else { 2.0 * radius });
    let outward = draw.circle();
    let target = wall.at(outward, 1.0, draw.range(-0.1, 1.1));
    let away = if inside { -outward } else { outward };
    let sideways = outward.perp() * draw.range(-0.4, 0.4);
    let mut origin = target + spread((away + sideways) * gap, 0.0);
    origin.y = height * draw.range(-1.0, 2.0);
    wall.setup(draw.ray_to(origin, target), format!("R {radius:.1e} h {height:.1e} gap {gap:.1e}"))
}

pub(super) fn far(draw: &mut Draw, _: usize) -> Setup {
    let (bottom, radius) = (draw.center(5.0), draw.magnitude(0.01, 10.0));
    let wall = Wall::new(bottom, radius * draw.magnitude(1.0, 10.0), radius);
    let distance = draw.magnitude(1e2, 1e7);
    let outward = draw.circle();
    // Beside the axis, in some cases above or below the wall.
    let target = wall.at(outward.perp(), draw.range(-1.1, 1.1), draw.range(-0.1, 1.1));
    let origin = target + spread(outward, draw.signed_magnitude(1e-3, 1.0)) * distance * radius;
    wall.setup(draw.ray_to(origin, target), format!("distance/radius {distance:.1e}"))
}

pub(super) fn surface_exact(draw: &mut Draw, index: usize) -> Setup {
    // Euclid's formula: two integers give a vector of integer length.
    let (m, n) = (f64::from(draw.integer(2, 30)), f64::from(draw.integer(1, 30)));
    let mut offset = DVec2::new((m * m - n * n) * draw.sign(), 2.0 * m * n * draw.sign());
    if draw.chance(0.5) {
        offset = offset.perp();
    }
    let unit = libm::ldexp(1.0, draw.integer(-10, 7));
    let bottom = if draw.chance(0.5) { DVec3::ZERO } else { draw.lattice(1 << 11, unit) };
    let radius = (m * m + n * n) * unit;
    let wall = Wall::new(bottom, radius * draw.magnitude(0.5, 6.0), radius);
    let mut origin = bottom + spread(offset * unit, 0.0);
    origin.y += wall.height * draw.range(0.1, 0.9);
    let (direction, note) = draw.through_surface(spread(offset, 0.0), index);
    wall.setup(ray(origin, direction), format!("on the wall, {note}"))
}

pub(super) fn surface_round(draw: &mut Draw, index: usize) -> Setup {
    let (bottom, radius) = (draw.center(10.0), draw.magnitude(0.01, 1e3));
    let wall = Wall::new(bottom, radius * draw.magnitude(0.3, 3.0), radius);
    let outward = draw.circle();
    let origin = wall.at(outward, 1.0, draw.range(0.1, 0.9));
    let (direction, note) = draw.through_surface(spread(outward, 0.0), index);
    wall.setup(ray(origin, direction), format!("rounded wall point, {note}"))
}
