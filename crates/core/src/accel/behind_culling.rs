//! Culling of what lies behind: without mirrors, no ray turns back.
//!
//! Rays from the eye go forward, and shadow rays go from their hits to the lights. All of them stay
//! in front of the eye, or of the light that is farthest behind it, because a half space is convex.

use crate::scene::{Cylinder, Scene, Sphere, Triangle, unit};
use crate::shapes::MARGIN;
use glam::DVec3;
use std::borrow::Cow;

/// Returns the scene without the spheres, triangles and cylinders that lie behind all that its
/// camera's rays reach. The others keep their order, which decides between equal distances.
pub(crate) fn cull_behind(scene: &Scene, roundoff: f64) -> Cow<'_, Scene> {
    if scene.materials.iter().any(|material| material.reflection > 0.0) {
        return Cow::Borrowed(scene);
    }
    let eye = scene.camera.position;
    let forward = unit(scene.camera.look_at - eye);
    let height = |point: DVec3| forward.dot(point - eye);
    let lowest = scene.lights.iter().map(|light| height(light.position)).fold(0.0, f64::min);
    // The primitive extends from `center` by `radius` in any direction.
    let reached = |center: DVec3, radius: f64| {
        let reach = forward.abs().dot(center.abs() + eye.abs()) + radius;
        // NaN, from numbers whose sum overflows, is not behind.
        let behind = height(center) + radius < lowest - MARGIN * roundoff * reach;
        !behind
    };
    let spheres = |sphere: &Sphere| reached(sphere.center, sphere.radius);
    let triangles = |triangle: &Triangle| triangle.vertices.iter().any(|&v| reached(v, 0.0));
    let cylinders = |cylinder: &Cylinder| {
        [cylinder.bottom, cylinder.top].iter().any(|&end| reached(end, cylinder.radius))
    };
    if scene.spheres.iter().all(spheres)
        && scene.triangles.iter().all(triangles)
        && scene.cylinders.iter().all(cylinders)
    {
        return Cow::Borrowed(scene);
    }
    Cow::Owned(Scene {
        camera: scene.camera,
        render: scene.render,
        lights: scene.lights.clone(),
        materials: scene.materials.clone(),
        planes: scene.planes.clone(),
        spheres: scene.spheres.iter().copied().filter(spheres).collect(),
        triangles: scene.triangles.iter().copied().filter(triangles).collect(),
        cylinders: scene.cylinders.iter().copied().filter(cylinders).collect(),
    })
}
