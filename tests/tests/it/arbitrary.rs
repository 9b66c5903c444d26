//! Primitives and rays drawn by proptest, as multiples of 1/256.

use glam::DVec3;
use proptest::collection::vec;
use proptest::prelude::*;
use rayweave_core::scene::{Cylinder, Triangle};
use rayweave_tests::model::{Primitive, Ray};
use rayweave_tests::scenes::{self, of};

fn coordinate() -> impl Strategy<Value = f64> {
    (-2048..=2048i32).prop_map(|k| f64::from(k) / 256.0)
}

pub(crate) fn point() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

pub(crate) fn direction() -> impl Strategy<Value = DVec3> {
    point().prop_filter("no direction", |v| *v != DVec3::ZERO)
}

/// From 1/256 to 4, small as often as large.
pub(crate) fn size() -> impl Strategy<Value = f64> {
    prop_oneof![1..=8i32, 8..=128, 128..=1024].prop_map(|k| f64::from(k) / 256.0)
}

pub(crate) fn plane() -> impl Strategy<Value = Primitive> {
    (point(), direction()).prop_map(|(point, normal)| scenes::plane(point, normal))
}

fn sphere() -> impl Strategy<Value = Primitive> {
    (point(), size()).prop_map(|(center, radius)| scenes::sphere(center, radius))
}

pub(crate) fn triangle() -> impl Strategy<Value = Primitive> {
    [point(), point(), point()]
        .prop_map(scenes::triangle)
        .prop_filter("no area", |triangle| of([*triangle]).check().is_ok())
}

fn cylinder() -> impl Strategy<Value = Primitive> {
    (point(), size(), size()).prop_map(|(bottom, h, radius)| scenes::cylinder(bottom, h, radius))
}

pub(crate) fn primitive() -> impl Strategy<Value = Primitive> {
    prop_oneof![plane(), sphere(), triangle(), cylinder()]
}

pub(crate) fn ray() -> impl Strategy<Value = Ray> {
    (point(), direction()).prop_map(|(origin, direction)| Ray { origin, direction })
}

/// Each component in -1..=1, so that some aims are beside a sphere and some hit it at its outline.
pub(crate) fn share() -> impl Strategy<Value = DVec3> {
    point().prop_map(|point| point / 8.0)
}

/// One of these primitives, and a ray towards it.
pub(crate) fn aimed_at(
    one: impl Strategy<Value = Primitive>,
) -> impl Strategy<Value = (Primitive, Ray)> {
    (one, ray(), share())
        .prop_map(|(primitive, ray, share)| (primitive, aimed(&ray, &primitive, share)))
}

/// Up to eight primitives, and a ray towards the first.
pub(crate) fn several() -> impl Strategy<Value = (Vec<Primitive>, Ray)> {
    (vec(primitive(), 1..=8), ray(), share()).prop_map(|(primitives, ray, share)| {
        let ray = aimed(&ray, &primitives[0], share);
        (primitives, ray)
    })
}

/// Turns a ray towards a primitive: `share` of its size beside its middle, or beyond the corner of
/// a triangle.
pub(crate) fn aimed(ray: &Ray, primitive: &Primitive, share: DVec3) -> Ray {
    let target = match *primitive {
        Primitive::Plane(plane) => plane.point + 8.0 * share,
        Primitive::Sphere(sphere) => sphere.center + sphere.radius * share,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            a + (b - a) * share.x.abs() + (c - a) * share.y.abs()
        }
        Primitive::Cylinder(Cylinder { bottom, top, radius, .. }) => {
            bottom.midpoint(top) + DVec3::new(radius, 0.5 * (top.y - bottom.y), radius) * share
        }
    };
    let direction = target - ray.origin;
    if direction == DVec3::ZERO { *ray } else { Ray { direction, ..*ray } }
}
