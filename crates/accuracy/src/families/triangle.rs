//! Families of triangles.

use glam::DVec3;

use super::Setup;
use super::draw::{Draw, ray, single};
use crate::cases::{Primitive, Ray};

fn setup([a, b, c]: [DVec3; 3], ray: Ray, note: String) -> Setup {
    Setup { primitive: Primitive::Triangle { a: single(a), b: single(b), c: single(c) }, ray, note }
}

/// Returns a point of the triangle's plane, given its weights at `b` and `c`.
fn at([a, b, c]: [DVec3; 3], at_b: f64, at_c: f64) -> DVec3 {
    a + (b - a) * at_b + (c - a) * at_c
}

/// Draws a point inside the triangle, uniformly distributed.
pub(super) fn inside(draw: &mut Draw, triangle: [DVec3; 3]) -> DVec3 {
    let (at_b, at_c) = (draw.range(0.0, 1.0), draw.range(0.0, 1.0));
    if at_b + at_c > 1.0 { at(triangle, 1.0 - at_b, 1.0 - at_c) } else { at(triangle, at_b, at_c) }
}

/// Draws a point inside the triangle, in some cases beside the edge opposite to `b`.
fn mostly_inside(draw: &mut Draw, triangle: [DVec3; 3]) -> DVec3 {
    if draw.chance(0.75) {
        inside(draw, triangle)
    } else {
        at(triangle, -draw.range(0.0, 0.5), draw.range(0.0, 1.0))
    }
}

/// Draws a ray to the target from a distance of 1 or more.
fn aimed(draw: &mut Draw, target: DVec3) -> Ray {
    let origin = draw.away_from(target);
    draw.ray_to(origin, target)
}

fn ordinary(draw: &mut Draw) -> [DVec3; 3] {
    let center = draw.within(3.0);
    std::array::from_fn(|_| center + draw.within(2.0))
}

pub(super) fn basic(draw: &mut Draw, _: usize) -> Setup {
    let triangle = ordinary(draw);
    let target = mostly_inside(draw, triangle);
    setup(triangle, aimed(draw, target), "control".into())
}

pub(super) fn needle(draw: &mut Draw, _: usize) -> Setup {
    let width = draw.magnitude(1e-6, 0.01);
    let (a, along) = (draw.within(2.0), draw.unit());
    let b = a + along * draw.range(0.5, 3.0);
    let triangle = [a, b, b + draw.across(along) * width];
    let (length, across) = (draw.range(0.05, 1.0), draw.range(-0.3, 1.3));
    let target = at(triangle, length * (1.0 - across), length * across);
    setup(triangle, aimed(draw, target), format!("width {width:.1e}"))
}

pub(super) fn sliver(draw: &mut Draw, _: usize) -> Setup {
    let height = draw.magnitude(1e-6, 0.01);
    let (a, along) = (draw.within(2.0), draw.unit());
    let length = draw.range(0.5, 3.0);
    let foot = a + along * length * draw.range(0.2, 0.8);
    let triangle = [a, a + along * length, foot + draw.across(along) * height];
    let target = mostly_inside(draw, triangle);
    setup(triangle, aimed(draw, target), format!("height {height:.1e}"))
}

pub(super) fn tiny_far(draw: &mut Draw, _: usize) -> Setup {
    let (size, distance) = (draw.magnitude(1e-3, 1.0), draw.magnitude(1e2, 3e5));
    let center = draw.unit() * size * distance;
    let triangle = std::array::from_fn(|_| center + draw.within(size));
    let target = mostly_inside(draw, triangle);
    let origin = draw.within(size.min(0.75));
    setup(triangle, draw.ray_to(origin, target), format!("distance/size {distance:.1e}"))
}

pub(super) fn edge_on(draw: &mut Draw, _: usize) -> Setup {
    let triangle @ [a, b, c] = ordinary(draw);
    let angle = draw.magnitude(1e-6, 0.03);
    let normal = (b - a).cross(c - a).normalize();
    let direction = (draw.across(normal) + normal * (angle * draw.sign())).normalize();
    let origin = mostly_inside(draw, triangle) - direction * draw.range(2.0, 8.0);
    setup(triangle, ray(origin, direction), format!("angle {angle:.1e}"))
}

pub(super) fn edge(draw: &mut Draw, index: usize) -> Setup {
    let mut triangle = ordinary(draw);
    let inward = draw.signed_magnitude(1e-7, 0.01);
    let target = at(triangle, inward, draw.range(0.05, 0.95) * (1.0 - inward));
    triangle.rotate_left(index % 3);
    setup(triangle, aimed(draw, target), format!("barycentric {inward:.1e}"))
}

pub(super) fn degenerate(draw: &mut Draw, index: usize) -> Setup {
    // The coordinates have few bits, so the vertices are exact.
    let (a, step) = (draw.lattice(512, 1.0 / 128.0), draw.lattice(256, 1.0 / 128.0));
    let mut times = || f64::from(draw.integer(-4, 4));
    let (mut triangle, note) = match index % 4 {
        0 => ([a, a, a + step], "two equal vertices"),
        1 => ([a, a, a], "point"),
        2 => ([a, a + step * times(), a + step * times()], "collinear"),
        // All bits of f32: doubling and quadrupling are exact.
        _ => {
            let b = super::draw::rounded(draw.unit());
            ([DVec3::ZERO, b, b * if draw.chance(0.5) { -4.0 } else { 2.0 }], "collinear")
        }
    };
    triangle.rotate_left(index / 4 % 3);
    let target = inside(draw, triangle);
    setup(triangle, aimed(draw, target), note.into())
}
