//! Whole scenes enlarged, moved and mirrored: camera, lights and primitives together, so that the
//! image stays what it was, or becomes its mirror image.

use glam::DVec3;
use rayweave_core::Scene;

/// Enlarges a scene by `factor` around the origin. For a power of two nothing is rounded.
#[must_use]
pub fn enlarged(scene: &Scene, factor: f64) -> Scene {
    let mut enlarged = with_points(scene, |point| point * factor);
    enlarged.spheres.iter_mut().for_each(|sphere| sphere.radius *= factor);
    enlarged.cylinders.iter_mut().for_each(|cylinder| cylinder.radius *= factor);
    enlarged
}

/// Moves a scene by `offset`.
#[must_use]
pub fn moved(scene: &Scene, offset: DVec3) -> Scene {
    with_points(scene, |point| point + offset)
}

/// Mirrors a scene in the plane through the origin at a right angle to `AXIS`: 0 is x, 1 is y, 2
/// is z.
#[must_use]
pub fn mirrored<const AXIS: usize>(scene: &Scene) -> Scene {
    let mirror = |v: DVec3| {
        let mut v = v.to_array();
        v[AXIS] = -v[AXIS];
        DVec3::from_array(v)
    };
    let mut mirrored = with_points(scene, mirror);
    mirrored.camera.up = mirror(scene.camera.up);
    mirrored.planes.iter_mut().for_each(|plane| plane.normal = mirror(plane.normal));
    if AXIS == 1 {
        mirrored.cylinders.iter_mut().for_each(|c| std::mem::swap(&mut c.bottom, &mut c.top));
    }
    mirrored
}

/// Rounds every coordinate and radius to `f32`, so that no precision rounds it again.
#[must_use]
pub fn rounded(scene: &Scene) -> Scene {
    let round = |x: f64| f64::from(x as f32);
    let mut rounded = with_points(scene, |point| point.map(round));
    rounded.planes.iter_mut().for_each(|plane| plane.normal = plane.normal.map(round));
    rounded.spheres.iter_mut().for_each(|sphere| sphere.radius = round(sphere.radius));
    rounded.cylinders.iter_mut().for_each(|cylinder| cylinder.radius = round(cylinder.radius));
    rounded
}

fn with_points(scene: &Scene, to: impl Fn(DVec3) -> DVec3) -> Scene {
    let mut scene = scene.clone();
    let place = |point: &mut DVec3| *point = to(*point);
    place(&mut scene.camera.position);
    place(&mut scene.camera.look_at);
    scene.lights.iter_mut().for_each(|light| place(&mut light.position));
    scene.planes.iter_mut().for_each(|plane| place(&mut plane.point));
    scene.spheres.iter_mut().for_each(|sphere| place(&mut sphere.center));
    scene.triangles.iter_mut().flat_map(|triangle| &mut triangle.vertices).for_each(place);
    for cylinder in &mut scene.cylinders {
        place(&mut cylinder.bottom);
        place(&mut cylinder.top);
    }
    scene
}
