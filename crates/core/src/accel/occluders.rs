//! The primitives that may lie between a light and the points it lights.
//!
//! A surface hides the light from points on its other side. The light's side is found once, from
//! the scene's numbers as they are written, in `f64` whatever the precision of the image is. A
//! shadow ray then has to find the side of its start alone. No rounding error of a `t` decides at
//! its far end, however flat the ray is. A surface that passes through the light hides nothing
//! there.

use super::cones::ConeSet;
use crate::scene::{Cylinder, Scene, Sphere};
use crate::shapes::quadric::Center;
use crate::shapes::side::{IN_SURFACE, Side, WRITTEN};
use crate::shapes::triangle::Triangle;
use crate::simd::lane::Scalar;
use crate::simd::vector::Vector;
use glam::DVec3;

/// The primitives that a shadow ray to one light has to try.
#[derive(Clone, Debug)]
pub(crate) struct Occluders<S> {
    /// The planes, by number, and their sides that the light is on.
    pub(crate) planes: Vec<(u32, Side)>,
    /// The direction cones of all other primitives, seen from the light. Without cones a shadow ray
    /// tries each of them.
    pub(crate) cones: Option<ConeSet<S>>,
    /// The spheres and cylinders around or close to the light, by ascending number. They are tried
    /// apart from the others, by formulas that start from the light.
    pub(crate) near: Vec<NearLight<S>>,
    pub(super) light: Vector<S>,
    /// The sides of triangles whose planes are so close to the light that this precision cannot
    /// tell them, by ascending number.
    sides: Vec<(u32, Side)>,
}

/// A sphere or a cylinder around or close to a light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearLight<S> {
    /// The number of the primitive.
    pub(crate) number: u32,
    pub(crate) center: Center<S>,
}

impl<S: Scalar> Occluders<S> {
    /// Finds the light's sides of `scene`'s primitives.
    pub(crate) fn new(
        scene: &Scene,
        light: DVec3,
        planes: Vec<(u32, Side)>,
        cones: Option<ConeSet<S>>,
    ) -> Self {
        Self {
            planes,
            cones,
            near: near_light(scene, light),
            light: Vector::rounded(light),
            sides: sides_of_triangles::<S>(scene, light),
        }
    }

    /// Returns whether the light lies in a plane, or in that of a triangle, as far as this
    /// precision can tell.
    pub(crate) fn is_in_flat_surface(&self, scene: &Scene, light: DVec3) -> bool {
        let side = |plane| Side::of_plane(plane, light, IN_SURFACE * S::ROUNDOFF);
        !self.sides.is_empty() || scene.planes.iter().any(|plane| side(plane) == Side::Unknown)
    }

    /// Returns the light's side of the plane of the triangle with this number.
    #[inline(always)]
    pub(crate) fn side(&self, number: u32, triangle: &Triangle<S>) -> Side {
        if !self.sides.is_empty()
            && let Ok(i) = self.sides.binary_search_by_key(&number, |&(number, _)| number)
        {
            return self.sides[i].1;
        }
        let above = triangle.normal.dot(self.light - triangle.vertices[0]);
        if S::literal(0.0).lt(above) { Side::Front } else { Side::Back }
    }

    /// Returns whether the sphere or cylinder with this number is near the light.
    #[inline(always)]
    pub(crate) fn is_near(&self, number: u32) -> bool {
        self.near.binary_search_by_key(&number, |near| near.number).is_ok()
    }
}

/// Returns the side of `light` on each triangle's plane that this precision cannot tell for
/// certain, by the triangle's number.
fn sides_of_triangles<S: Scalar>(scene: &Scene, light: DVec3) -> Vec<(u32, Side)> {
    let rounded = |v: DVec3| Vector::<S>::rounded(v).widened();
    let first = scene.planes.len() + scene.spheres.len();
    let unsure = (first as u32..).zip(&scene.triangles).filter(|(_, triangle)| {
        let corners = triangle.vertices.map(rounded);
        Side::of_corners(corners, rounded(light), S::ROUNDOFF) == Side::Unknown
    });
    unsure
        .map(|(number, triangle)| (number, Side::of_corners(triangle.vertices, light, WRITTEN)))
        .collect()
}

/// Returns the spheres and cylinders that hold `light`, or are closer to it than two fifths of
/// their radius: for the others the start of a ray tells as well whether it passes them.
fn near_light<S: Scalar>(scene: &Scene, light: DVec3) -> Vec<NearLight<S>> {
    let spheres =
        scene.spheres.iter().map(|&Sphere { center, radius, .. }| (DVec3::ONE, center, radius));
    // Across its axis a cylinder is a circle.
    let cylinders = scene
        .cylinders
        .iter()
        .map(|&Cylinder { bottom, radius, .. }| (DVec3::new(1.0, 0.0, 1.0), bottom, radius));
    let first = scene.planes.len() as u32;
    let first_cylinder = first + (scene.spheres.len() + scene.triangles.len()) as u32;
    (first..)
        .zip(spheres)
        .chain((first_cylinder..).zip(cylinders))
        .filter_map(|(number, (axes, center, radius))| {
            let outward = (light - center) * axes;
            let power = outward.length_squared() - radius * radius;
            // NaN, from numbers that overflow, is not near.
            let near = power <= radius * radius;
            let reach = outward.abs().dot(light.abs() + center.abs()) + radius * radius;
            let on_surface = power.abs() <= IN_SURFACE * WRITTEN * reach;
            let power = S::from_f64(if on_surface { 0.0 } else { power });
            let center = Center { light: Vector::rounded(outward), power };
            near.then_some(NearLight { number, center })
        })
        .collect()
}
