//! The ends of primitives: rims, lights in surfaces, and primitives that reach far beyond their
//! visible part.

use glam::{DVec3, dvec3 as v};
use rayweave_core::{Precision, Scene};
use rayweave_tests::scenes::{PRECISIONS, caster, cylinder, of, plane, triangle, with};

/// Catches a `<` for a `<=`: both rims and the outline of a tube belong to it.
#[test]
fn rims_and_outlines_belong_to_a_cylinder() {
    let scene = of([cylinder(v(0.0, -1.0, -2.0), 2.0, 1.0)]);
    for precision in PRECISIONS {
        let caster = caster(&scene, precision);
        let t = |x: f64, y: f64| caster.closest_hit(v(x, y, 0.0), -DVec3::Z).map(|hit| hit.t);
        assert_eq!((t(0.0, -1.0), t(0.0, 1.0)), (Some(1.0), Some(1.0)), "{precision}");
        assert_eq!((t(1.0, 0.0), t(-1.0, 0.0)), (Some(2.0), Some(2.0)), "{precision}");
    }
}

/// Sends 400 rays to the surface around `near`, which is lit from above, and counts those that
/// find less than half of the light that the brightest finds.
fn dark_rays(mut scene: Scene, near: DVec3, normal: DVec3) -> usize {
    scene.lights[0].position = near + 40.0 * normal;
    let caster = caster(&scene, Precision::F32);
    let offsets =
        (0..400).map(|i| v(f64::from(i % 20) / 20.0 - 0.5, -1.0, f64::from(i / 20) / 20.0 - 0.5));
    let sums: Vec<f64> =
        offsets.map(|d| caster.color(near + 3.0 * normal, d).iter().sum()).collect();
    let brightest = sums.iter().copied().fold(0.0, f64::max);
    sums.iter().filter(|sum| **sum < 0.5 * brightest).count()
}

/// Catches an offset bound that leaves out the shape's own coordinates: the plane is given by a
/// point far from its visible part.
#[test]
fn a_plane_anchored_far_away_does_not_shadow_itself() {
    let narrow = |v: DVec3| v.as_vec3().as_dvec3();
    let normal = v(0.25, 1.0, 0.1875);
    let (near, along) = (v(0.3, 0.7, -0.2), normal.cross(v(0.6, 0.1, 0.5)).normalize());
    for sign in [-1.0, 1.0] {
        let anchor = narrow(near + sign * 1e5 * along);
        let near = anchor - sign * 1e5 * along;
        assert_eq!(dark_rays(of([plane(anchor, normal)]), near, normal), 0, "{sign}");
    }
}

/// Catches a shadow ray that ends at the light or beyond: a wall through the light does not hide
/// it.
#[test]
fn a_surface_through_a_light_does_not_hide_it() {
    let light = v(1.25, 4.5, -0.75);
    let normal = v(1.0, 2.0, -1.0);
    let corners = [v(9.0, -3.0, 3.0), v(-12.0, 4.0, -4.0), v(3.0, -3.0, -3.0)].map(|c| light + c);
    let mut open = of([plane(v(0.0, -3.0, 0.0), v(0.1, 1.0, 0.2))]);
    open.lights[0].position = light;
    let walls = [plane(light + 8.0 * v(3.0, -1.0, 1.0), normal), triangle(corners)];
    for (wall, precision) in walls.into_iter().flat_map(|wall| PRECISIONS.map(|p| (wall, p))) {
        let walled = caster(&with(open.clone(), [wall]), precision);
        let free = caster(&open, precision);
        for i in 0..900 {
            let d = v(f64::from(i % 30) / 15.0 - 1.0, -1.0, f64::from(i / 30) / 15.0 - 1.0);
            let eye = v(0.3, -1.7, 0.2);
            assert_eq!(walled.color(eye, d), free.color(eye, d), "{precision} {i}");
        }
    }
}

/// Catches an offset bound that leaves out corners far away.
#[test]
fn a_triangle_with_far_corners_does_not_shadow_itself() {
    let narrow = |v: DVec3| v.as_vec3().as_dvec3();
    let normal = v(0.25, 1.0, 0.1875);
    let (x, y) =
        (normal.cross(v(0.6, 0.1, 0.5)).normalize(), normal.cross(v(0.5, 0.1, -0.6)).normalize());
    let near = v(0.3, 0.7, -0.2);
    let far = [near + 1e5 * x, near - 1e5 * x + 1e5 * y, near - 1e5 * y - 1e5 * x].map(narrow);
    for turn in 0..3 {
        let vertices = [far[turn], far[(turn + 1) % 3], far[(turn + 2) % 3]];
        assert_eq!(dark_rays(of([triangle(vertices)]), near, normal), 0, "{turn}");
    }
}
