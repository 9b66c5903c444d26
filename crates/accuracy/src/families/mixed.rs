//! Families that cover several kinds of primitives.

use glam::DVec3;

use super::draw::{Draw, ray, single};
use super::{Setup, cylinder, plane, sphere, triangle};
use crate::cases::{Primitive, Ray, double};

/// Draws a control case, of each kind in turn, with a direction of unit length.
fn control(draw: &mut Draw, index: usize) -> Setup {
    let kinds = [plane::basic, sphere::basic, triangle::basic, cylinder::basic];
    let mut setup = kinds[index % 4](draw, index);
    setup.ray.direction = single(double(setup.ray.direction).normalize());
    setup
}

/// Moves all positions by `place` and multiplies all lengths by `scale`.
fn moved(setup: Setup, scale: f64, place: impl Fn(DVec3) -> DVec3, note: String) -> Setup {
    let put = |position: [f32; 3]| single(place(double(position)));
    let long = |length: f32| (f64::from(length) * scale) as f32;
    let primitive = match setup.primitive {
        Primitive::Plane { point, normal } => Primitive::Plane { point: put(point), normal },
        Primitive::Sphere { center, radius } => {
            Primitive::Sphere { center: put(center), radius: long(radius) }
        }
        Primitive::Triangle { a, b, c } => Primitive::Triangle { a: put(a), b: put(b), c: put(c) },
        Primitive::Cylinder { bottom, top, radius } => {
            Primitive::Cylinder { bottom: put(bottom), top: put(top), radius: long(radius) }
        }
        Primitive::Mesh { triangles } => Primitive::Mesh {
            triangles: triangles.into_iter().map(|triangle| triangle.map(put)).collect(),
        },
    };
    Setup { primitive, ray: Ray { origin: put(setup.ray.origin), ..setup.ray }, note }
}

pub(super) fn direction_scale(draw: &mut Draw, index: usize) -> Setup {
    let mut setup = control(draw, index);
    let length = draw.magnitude(1e-30, 1e34);
    setup.ray.direction = single(double(setup.ray.direction) * length);
    Setup { note: format!("|d| = {length:.1e}"), ..setup }
}

pub(super) fn scale(draw: &mut Draw, index: usize) -> Setup {
    let scale = draw.magnitude(1e-4, 2e6);
    moved(control(draw, index), scale, |position| position * scale, format!("scale {scale:.1e}"))
}

pub(super) fn offset(draw: &mut Draw, index: usize) -> Setup {
    let mut coordinate = || draw.signed_magnitude(1e5, 1e6);
    let offset = DVec3::new(coordinate(), coordinate(), coordinate());
    let note = format!("offset {:.1e}", offset.length());
    moved(control(draw, index), 1.0, |position| position + offset, note)
}

pub(super) fn flat_surface_exact(draw: &mut Draw, index: usize) -> Setup {
    let axis = draw.integer(0, 2) as usize;
    let direction = draw.unit();
    if index % 2 == 1 {
        // Perpendicular to an axis: all vertices and the origin share a coordinate.
        let level = draw.range(-5.0, 5.0);
        let corners = std::array::from_fn(|_| {
            let mut corner = draw.within(5.0);
            corner[axis] = level;
            corner
        });
        let mut origin = triangle::inside(draw, corners);
        origin[axis] = level;
        let [a, b, c] = corners.map(single);
        let primitive = Primitive::Triangle { a, b, c };
        return Setup {
            primitive,
            ray: ray(origin, direction),
            note: "origin on the triangle".into(),
        };
    }
    let (point, normal, way) = if index.is_multiple_of(4) {
        let mut way = draw.within(2.0);
        way[axis] = 0.0;
        (draw.within(5.0), DVec3::AXES[axis] * draw.sign(), way)
    } else {
        // At an angle, with so few bits that no product rounds.
        let normal = draw.lattice(4, 1.0) + DVec3::splat(0.5);
        (draw.lattice(320, 1.0 / 64.0), normal, normal.cross(draw.lattice(4, 1.0 / 4.0)))
    };
    let primitive = Primitive::Plane { point: single(point), normal: single(normal) };
    Setup { primitive, ray: ray(point + way, direction), note: "origin on the plane".into() }
}

pub(super) fn invalid(draw: &mut Draw, index: usize) -> Setup {
    let mut setup = control(draw, index);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][draw.integer(0, 2) as usize];
    let axis = draw.integer(0, 2) as usize;
    setup.note = match index / 4 % 5 {
        0 => {
            setup.ray.direction =
                std::array::from_fn(|_| if draw.chance(0.5) { 0.0 } else { -0.0 });
            "no direction".into()
        }
        1 => {
            setup.ray.direction[axis] = bad;
            "direction".into()
        }
        2 => {
            setup.ray.origin[axis] = bad;
            "origin".into()
        }
        3 => {
            setup.ray.direction = [bad; 3];
            "whole direction".into()
        }
        _ => {
            spoil(&mut setup.primitive, axis, bad, draw.chance(0.5));
            "primitive".into()
        }
    };
    setup
}

/// Puts `bad` into a position of the primitive, or into another of its numbers.
fn spoil(primitive: &mut Primitive, axis: usize, bad: f32, position: bool) {
    match primitive {
        Primitive::Plane { point: at, .. } if position => at[axis] = bad,
        Primitive::Sphere { center: at, .. } if position => at[axis] = bad,
        Primitive::Cylinder { bottom, top, .. } if position => {
            bottom[axis] = bad;
            top[axis] = bad;
        }
        Primitive::Triangle { a: at, .. } if position => at[axis] = bad,
        Primitive::Plane { normal, .. } => normal[axis] = bad,
        Primitive::Sphere { radius, .. } | Primitive::Cylinder { radius, .. } => *radius = bad,
        Primitive::Triangle { c: at, .. } => at[axis] = bad,
        Primitive::Mesh { triangles } => {
            triangles.iter_mut().for_each(|triangle| triangle[0][axis] = bad);
        }
    }
}
