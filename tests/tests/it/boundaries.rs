//! Where one thing ends and what lies beside it begins: rims, lights in surfaces, things that reach
//! far beyond what is seen of them.

use glam::DVec3;
use rayweave_core::scene::{Cylinder, Plane, Triangle};
use rayweave_core::{Caster, Precision, Scene};
use rayweave_tests::scenes::empty;

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Catches a `<` for a `<=`: both rims and the outline of a tube belong to it.
#[test]
fn rims_and_outlines_belong_to_a_cylinder() {
    let tube =
        Cylinder { bottom: v(0.0, -1.0, -2.0), top: v(0.0, 1.0, -2.0), radius: 1.0, material: 0 };
    let scene = Scene { cylinders: vec![tube], ..empty() };
    for precision in PRECISIONS {
        let caster = Caster::new(&scene.with_arithmetic(precision)).expect("a sound scene");
        let t = |x: f64, y: f64| caster.closest_hit(v(x, y, 0.0), -DVec3::Z).map(|hit| hit.t);
        assert_eq!((t(0.0, -1.0), t(0.0, 1.0)), (Some(1.0), Some(1.0)), "{precision}");
        assert_eq!((t(1.0, 0.0), t(-1.0, 0.0)), (Some(2.0), Some(2.0)), "{precision}");
    }
}

/// Of 400 rays to the surface around `near`, which is lit from above, those that find less than
/// half of the light that the luckiest finds.
fn dark_pixels(scene: &Scene, near: DVec3, normal: DVec3) -> usize {
    let mut scene = scene.clone();
    scene.lights.truncate(1);
    scene.lights[0].position = near + 40.0 * normal;
    let caster = Caster::new(&scene.with_arithmetic(Precision::F32)).expect("a sound scene");
    let offsets =
        (0..400).map(|i| v(f64::from(i % 20) / 20.0 - 0.5, -1.0, f64::from(i / 20) / 20.0 - 0.5));
    let sums: Vec<f64> =
        offsets.map(|d| caster.color(near + 3.0 * normal, d).iter().sum()).collect();
    let brightest = sums.iter().copied().fold(0.0, f64::max);
    sums.iter().filter(|sum| **sum < 0.5 * brightest).count()
}

/// Catches an offset bound that leaves out the shape's own coordinates: the plane is given by a point
/// far from what is seen of it.
#[test]
fn a_plane_anchored_far_away_does_not_shadow_itself() {
    let narrow = |v: DVec3| v.map(|x| f64::from(x as f32));
    let normal = v(0.25, 1.0, 0.1875);
    let (near, along) = (v(0.3, 0.7, -0.2), normal.cross(v(0.6, 0.1, 0.5)).normalize());
    for sign in [-1.0, 1.0] {
        let anchor = narrow(near + sign * 1e5 * along);
        let near = anchor - sign * 1e5 * along;
        let plane = Plane { point: anchor, normal, material: 0 };
        assert_eq!(
            dark_pixels(&Scene { planes: vec![plane], ..empty() }, near, normal),
            0,
            "{sign}"
        );
    }
}

/// Catches a shadow ray that ends at the light or beyond: a wall through the light does not hide
/// it.
#[test]
fn a_surface_through_a_light_does_not_hide_it() {
    let light = v(1.25, 4.5, -0.75);
    let normal = v(1.0, 2.0, -1.0);
    let corners = [v(9.0, -3.0, 3.0), v(-12.0, 4.0, -4.0), v(3.0, -3.0, -3.0)].map(|c| light + c);
    let floor = Plane { point: v(0.0, -3.0, 0.0), normal: v(0.1, 1.0, 0.2), material: 0 };
    let mut open = Scene { planes: vec![floor], ..empty() };
    open.lights.truncate(1);
    open.lights[0].position = light;
    let wall = Plane { point: light + 8.0 * v(3.0, -1.0, 1.0), normal, material: 0 };
    let walls = [
        Scene { planes: vec![floor, wall], ..open.clone() },
        Scene { triangles: vec![Triangle { vertices: corners, material: 0 }], ..open.clone() },
    ];
    for (scene, precision) in walls.iter().flat_map(|scene| PRECISIONS.map(|p| (scene, p))) {
        let caster = Caster::new(&scene.with_arithmetic(precision)).expect("a sound scene");
        let free = Caster::new(&open.with_arithmetic(precision)).expect("a sound scene");
        for i in 0..900 {
            let d = v(f64::from(i % 30) / 15.0 - 1.0, -1.0, f64::from(i / 30) / 15.0 - 1.0);
            let eye = v(0.3, -1.7, 0.2);
            assert_eq!(caster.color(eye, d), free.color(eye, d), "{precision} {i}");
        }
    }
}

/// Catches an offset bound that leaves out corners far away.
#[test]
fn a_triangle_with_far_corners_does_not_shadow_itself() {
    let narrow = |v: DVec3| v.map(|x| f64::from(x as f32));
    let normal = v(0.25, 1.0, 0.1875);
    let (x, y) =
        (normal.cross(v(0.6, 0.1, 0.5)).normalize(), normal.cross(v(0.5, 0.1, -0.6)).normalize());
    let near = v(0.3, 0.7, -0.2);
    let far = [near + 1e5 * x, near - 1e5 * x + 1e5 * y, near - 1e5 * y - 1e5 * x].map(narrow);
    for turn in 0..3 {
        let vertices = [far[turn], far[(turn + 1) % 3], far[(turn + 2) % 3]];
        let triangle = Triangle { vertices, material: 0 };
        assert_eq!(
            dark_pixels(&Scene { triangles: vec![triangle], ..empty() }, near, normal),
            0,
            "{turn}"
        );
    }
}
