//! The model that the tracer is compared with, against values worked out by hand.

use glam::DVec3;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Scene, Sphere, Triangle,
};
use rayweave_tests::model::{
    Model, Primitive, Ray, cylinder_roots, plane_root, primary_ray, render, samples, sphere_roots,
    triangle_root,
};
use rayweave_tests::random_scene::random_scene;

const RED: usize = 0;
const GREEN: usize = 1;
const BLUE: usize = 2;

/// No thing and no light, three materials that are seen without light, a grey background.
fn empty() -> Scene {
    let glowing =
        |color| Material { ambient: 1.0, diffuse: 0.0, specular: 0.0, ..Material::new(color) };
    Scene {
        camera: Camera {
            position: DVec3::ZERO,
            look_at: -DVec3::Z,
            up: DVec3::Y,
            focal_length: 2.0,
            screen_width: 4.0,
        },
        render: RenderSettings {
            background: DVec3::splat(0.5),
            max_reflections: 4,
            antialiasing: 0,
            ..RenderSettings::default()
        },
        lights: Vec::new(),
        materials: [DVec3::X, DVec3::Y, DVec3::Z].map(glowing).to_vec(),
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    }
}

/// The colour that a ray brings.
fn seen(scene: &Scene, origin: impl Into<DVec3>, direction: impl Into<DVec3>) -> DVec3 {
    assert_eq!(scene.check(), Ok(()));
    Model::new(scene).trace(&ray(origin, direction.into().normalize()))
}

fn ray(origin: impl Into<DVec3>, direction: impl Into<DVec3>) -> Ray {
    Ray { origin: origin.into(), direction: direction.into() }
}

fn floor(material: usize) -> Plane {
    Plane { point: DVec3::ZERO, normal: DVec3::Y, material }
}

fn ball(center: impl Into<DVec3>, radius: f64, material: usize) -> Sphere {
    Sphere { center: center.into(), radius, material }
}

fn tube(bottom: impl Into<DVec3>, height: f64, radius: f64, material: usize) -> Cylinder {
    let bottom = bottom.into();
    Cylinder { bottom, top: bottom + height * DVec3::Y, radius, material }
}

fn lamp(position: impl Into<DVec3>) -> Light {
    Light { position: position.into(), color: DVec3::ONE, power: 1.0 }
}

#[track_caller]
fn assert_close(found: DVec3, expected: impl Into<DVec3>) {
    let expected = expected.into();
    assert!(found.distance(expected) < 1e-12, "{found} instead of {expected}");
}

// Camera

#[test]
fn the_middle_of_the_image_is_straight_ahead() {
    let camera = Camera {
        position: DVec3::new(1.0, 2.0, 3.0),
        look_at: DVec3::new(4.0, 6.0, 3.0),
        up: DVec3::new(0.0, 0.0, 7.0),
        focal_length: 0.3,
        screen_width: 5.0,
    };
    let ray = primary_ray(&camera, 2.0, 1.5, 4, 3);
    assert_eq!(ray.origin, camera.position);
    assert_close(ray.direction, [0.6, 0.8, 0.0]);
}

#[test]
fn the_screen_has_its_corners_where_they_belong() {
    // To -z, 2 away, 4 wide and so 3 high; to the right is +x, up is +y.
    let camera = empty().camera;
    for (x, y, corner) in [(0.0, 0.0, [-2.0, 1.5, -2.0]), (8.0, 6.0, [2.0, -1.5, -2.0])] {
        assert_close(
            primary_ray(&camera, x, y, 8, 6).direction,
            DVec3::from_array(corner).normalize(),
        );
    }
    // The centre of pixel (0, 0), the top left one.
    let expected = DVec3::new(-1.75, 1.25, -2.0).normalize();
    assert_close(primary_ray(&camera, 0.5, 0.5, 8, 6).direction, expected);
}

#[test]
fn up_is_neither_unit_nor_at_a_right_angle() {
    // Straight down: the top of the image is to -z, its right to +x.
    let down = Camera { look_at: -DVec3::Y, up: DVec3::new(0.0, 5.0, -0.2), ..empty().camera };
    let expected = DVec3::new(2.0, -2.0, -2.0).normalize();
    assert_close(primary_ray(&down, 8.0, 0.0, 8, 8).direction, expected);
}

#[test]
fn rows_come_from_the_top() {
    let scene = Scene { planes: vec![Plane { point: -DVec3::Y, ..floor(RED) }], ..empty() };
    let image = render(&scene, 2, 2);
    assert_eq!(image, [[0.5; 3], [0.5; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
}

#[test]
fn what_lies_before_the_screen_is_seen() {
    let scene = Scene { spheres: vec![ball([0.0, 0.0, -1.0], 0.1, RED)], ..empty() };
    assert_eq!(render(&scene, 1, 1), [[1.0, 0.0, 0.0]]);
}

// Nearest hit

#[test]
fn background() {
    let scene = Scene { planes: vec![floor(RED)], ..empty() };
    assert_eq!(seen(&scene, [0.0, 1.0, 0.0], [1.0, 0.1, 0.0]), DVec3::splat(0.5));
    assert_eq!(render(&empty(), 2, 1), [[0.5; 3]; 2]);
}

#[test]
fn a_sphere_has_two_roots() {
    let sphere = ball([0.0, 0.0, -5.0], 2.0, RED);
    assert_eq!(sphere_roots(&sphere, &ray([0.0; 3], [0.0, 0.0, -1.0])), [Some(3.0), Some(7.0)]);
    assert_eq!(sphere_roots(&sphere, &ray([0.0; 3], [0.0, 0.0, -2.0])), [Some(1.5), Some(3.5)]);
    assert_eq!(
        sphere_roots(&sphere, &ray([0.0, 0.0, -6.0], [0.0, 0.0, -1.0])),
        [Some(-3.0), Some(1.0)]
    );
}

#[test]
fn a_tangent_ray_hits_once_and_one_beside_it_does_not() {
    let along_z = ray([0.0; 3], [0.0, 0.0, 1.0]);
    assert_eq!(sphere_roots(&ball([3.0, 4.0, 9.0], 5.0, RED), &along_z), [Some(9.0); 2]);
    assert_eq!(sphere_roots(&ball([3.0, 4.0, 9.0], 4.999, RED), &along_z), [None; 2]);
    assert_eq!(cylinder_roots(&tube([5.0, -1.0, 9.0], 2.0, 5.0, RED), &along_z), [Some(9.0); 2]);
    assert_eq!(cylinder_roots(&tube([5.0, -1.0, 9.0], 2.0, 4.999, RED), &along_z), [None; 2]);
}

#[test]
fn parallel_rays_miss() {
    let triangle = Triangle { vertices: [DVec3::ZERO, DVec3::X, DVec3::Z], material: RED };
    for height in [0.0, 1.0] {
        let level = ray([-1.0, height, 0.25], [1.0, 0.0, 0.0]);
        assert_eq!(plane_root(&floor(RED), &level), None);
        assert_eq!(triangle_root(&triangle, &level), None);
    }
    for x in [0.0, 0.5, 1.0, 2.0] {
        let down = ray([x, 5.0, 0.0], [0.0, -1.0, 0.0]);
        assert_eq!(cylinder_roots(&tube([0.0; 3], 1.0, 1.0, RED), &down), [None; 2]);
    }
}

#[test]
fn a_triangle_includes_its_edges_and_corners() {
    let triangle = Triangle { vertices: [DVec3::ZERO, DVec3::X, DVec3::Y], material: RED };
    let [a, b, c] = triangle.vertices;
    let flipped = Triangle { vertices: [a, c, b], material: RED };
    for triangle in [triangle, flipped] {
        let at = |x: f64, y: f64| triangle_root(&triangle, &ray([x, y, 2.0], [0.0, 0.0, -1.0]));
        for (x, y) in
            [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.0, 0.5), (0.5, 0.0), (0.25, 0.25)]
        {
            assert_eq!(at(x, y), Some(2.0), "({x}, {y})");
        }
        for (x, y) in [(-0.001, 0.5), (0.5, -0.001), (0.501, 0.5), (1.001, 0.0), (-1.0, -1.0)] {
            assert_eq!(at(x, y), None, "({x}, {y})");
        }
    }
}

#[test]
fn the_far_wall_is_seen_through_the_open_end() {
    // Over the near rim, 2.5 - t falls to 1.5 at x = -1 and to 0.5 at x = 1.
    let tube = tube([0.0; 3], 1.0, 1.0, RED);
    let through = ray([-3.0, 2.5, 0.0], [2.0, -1.0, 0.0]);
    assert_eq!(cylinder_roots(&tube, &through), [None, Some(2.0)]);
    let scene = Scene { cylinders: vec![tube], ..empty() };
    assert_eq!(seen(&scene, through.origin, through.direction), DVec3::X);
    // The height's bounds belong to the wall.
    for y in [0.0, 1.0] {
        assert_eq!(
            cylinder_roots(&tube, &ray([-3.0, y, 0.0], [1.0, 0.0, 0.0])),
            [Some(2.0), Some(4.0)]
        );
    }
    for y in [-0.001, 1.001] {
        assert_eq!(cylinder_roots(&tube, &ray([-3.0, y, 0.0], [1.0, 0.0, 0.0])), [None; 2]);
    }
}

#[test]
fn the_closest_hit_is_in_front() {
    let scene = Scene {
        spheres: vec![ball([0.0, 0.0, 3.0], 1.0, RED), ball([0.0, 0.0, -9.0], 1.0, GREEN)],
        planes: vec![Plane {
            point: DVec3::new(0.0, 0.0, -20.0),
            normal: DVec3::Z,
            material: BLUE,
        }],
        ..empty()
    };
    assert_eq!(seen(&scene, [0.0; 3], [0.0, 0.0, -1.0]), DVec3::Y);
    assert_eq!(seen(&scene, [0.0; 3], [1.0, 0.0, -1.0]), DVec3::Z);
}

#[test]
fn a_ray_does_not_hit_what_it_starts_on() {
    // t = 0 is no hit, the other root is one.
    let scene =
        Scene { spheres: vec![ball([0.0; 3], 1.0, RED)], planes: vec![floor(GREEN)], ..empty() };
    assert_eq!(seen(&scene, [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]), DVec3::X);
    assert_eq!(seen(&scene, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), DVec3::X);
    assert_eq!(seen(&scene, [1.0, 0.0, 0.0], [1.0, 0.1, 0.0]), DVec3::splat(0.5));
}

#[test]
fn equal_distances_go_to_the_first_kind_then_to_the_first_in_the_file() {
    // Along -z from 0: all four kinds, at t = 2.
    let plane = |material| Plane { point: DVec3::new(0.0, 0.0, -2.0), normal: DVec3::Z, material };
    let sphere = |material| ball([0.0, 0.0, -3.0], 1.0, material);
    let triangle = |material| {
        let vertices =
            [[-1.0, -1.0, -2.0], [1.0, -1.0, -2.0], [0.0, 1.0, -2.0]].map(DVec3::from_array);
        Triangle { vertices, material }
    };
    let cylinder = |material| tube([0.0, -1.0, -3.0], 2.0, 1.0, material);
    let ahead = |scene: &Scene| seen(scene, [0.0; 3], [0.0, 0.0, -1.0]);

    let mut scene = Scene { cylinders: vec![cylinder(RED), cylinder(BLUE)], ..empty() };
    assert_eq!(ahead(&scene), DVec3::X);
    scene.triangles = vec![triangle(GREEN), triangle(BLUE)];
    assert_eq!(ahead(&scene), DVec3::Y);
    scene.spheres = vec![sphere(RED), sphere(BLUE)];
    assert_eq!(ahead(&scene), DVec3::X);
    scene.planes = vec![plane(GREEN), plane(BLUE)];
    assert_eq!(ahead(&scene), DVec3::Y);
}

// Shading

/// A floor of this material under a light at (0, 10, 0).
fn lit_floor(material: Material) -> Scene {
    Scene {
        materials: vec![material],
        planes: vec![floor(0)],
        lights: vec![lamp([0.0, 10.0, 0.0])],
        ..empty()
    }
}

/// Everything is 0 but the colour, which is (1, 1/2, 0).
fn dark() -> Material {
    let color = DVec3::new(1.0, 0.5, 0.0);
    Material { ambient: 0.0, diffuse: 0.0, specular: 0.0, ..Material::new(color) }
}

#[test]
fn a_lit_point() {
    // At (7.5, 0, 0): l = (-.6, .8, 0), n.l = .8, m = (.6, .8, 0). Seen along (-.8, -.6, 0), so
    // m.-d = .48 + .48 = .96.
    let mut scene =
        lit_floor(Material { ambient: 0.25, diffuse: 0.5, specular: 0.75, shininess: 3, ..dark() });
    scene.lights[0] = Light { color: DVec3::new(1.0, 0.5, 0.25), power: 2.0, ..scene.lights[0] };
    let from_right = seen(&scene, [15.5, 6.0, 0.0], [-0.8, -0.6, 0.0]);
    let highlight = 0.75 * 0.96f64.powi(3);
    let expected = [
        0.25 * 1.0 + 2.0 * 1.0 * (0.5 * 0.8 * 1.0 + highlight),
        0.25 * 0.5 + 2.0 * 0.5 * (0.5 * 0.8 * 0.5 + highlight),
        0.25 * 0.0 + 2.0 * 0.25 * (0.5 * 0.8 * 0.0 + highlight),
    ];
    assert_close(from_right, expected);
}

#[test]
fn a_highlight_is_on_one_side() {
    // From the left of the same point: m.-d = -.48 + .48 = 0 along (.8, -.6), below 0 farther down.
    let scene = lit_floor(Material { specular: 1.0, shininess: 1, ..dark() });
    assert_close(seen(&scene, [7.5 - 8.0, 6.0, 0.0], [0.8, -0.6, 0.0]), [0.0; 3]);
    assert_close(seen(&scene, [7.5 - 9.0, 1.0, 0.0], [9.0, -1.0, 0.0]), [0.0; 3]);
    assert_close(seen(&scene, [7.5 + 3.0, 4.0, 0.0], [-0.6, -0.8, 0.0]), [1.0; 3]);
}

#[test]
fn a_light_below_the_surface_gives_nothing() {
    let mut scene = lit_floor(Material { diffuse: 1.0, specular: 1.0, ..dark() });
    scene.lights[0].position = DVec3::new(4.0, -3.0, 0.0);
    assert_eq!(seen(&scene, [-4.0, 3.0, 0.0], [0.8, -0.6, 0.0]), DVec3::ZERO);
    // In the surface, and at the point itself.
    for x in [4.0, 0.0] {
        scene.lights[0].position = DVec3::new(x, 0.0, 0.0);
        assert_eq!(seen(&scene, [-4.0, 3.0, 0.0], [0.8, -0.6, 0.0]), DVec3::ZERO);
    }
}

#[test]
fn surfaces_are_two_sided() {
    // The floor from below, lit from below.
    let mut scene = lit_floor(Material { diffuse: 1.0, ..dark() });
    scene.lights[0].position = DVec3::new(0.0, -10.0, 0.0);
    assert_close(seen(&scene, [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]), [1.0, 0.5, 0.0]);
    scene.planes[0].normal = -5.0 * DVec3::Y;
    assert_close(seen(&scene, [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]), [1.0, 0.5, 0.0]);
}

#[test]
fn the_inside_of_a_tube_is_lit_from_inside() {
    // The far wall's normal is (-1, 0, 0), and the light straight before it.
    let scene = Scene {
        cylinders: vec![tube([0.0; 3], 1.0, 1.0, 0)],
        planes: Vec::new(),
        lights: vec![lamp([-0.5, 0.5, 0.0]), lamp([5.0, 0.5, 0.0])],
        ..lit_floor(Material { diffuse: 1.0, ..dark() })
    };
    assert_close(seen(&scene, [-3.0, 2.5, 0.0], [2.0, -1.0, 0.0]), [1.0, 0.5, 0.0]);
    // A light beyond the near wall is hidden by it, one over the rim is not.
    let outside = Scene { lights: vec![lamp([-5.0, 0.5, 0.0])], ..scene.clone() };
    assert_close(seen(&outside, [-3.0, 2.5, 0.0], [2.0, -1.0, 0.0]), [0.0; 3]);
    let above = Scene { lights: vec![lamp([-2.0, 4.5, 0.0])], ..scene };
    assert_close(seen(&above, [-3.0, 2.5, 0.0], [2.0, -1.0, 0.0]), [0.6, 0.3, 0.0]);
}

#[test]
fn the_inside_of_a_sphere_is_lit_from_inside() {
    let scene = Scene {
        spheres: vec![ball([0.0; 3], 2.0, 0)],
        planes: Vec::new(),
        lights: vec![lamp([0.0; 3]), lamp([0.0, 0.0, 9.0])],
        ..lit_floor(Material { diffuse: 1.0, ..dark() })
    };
    assert_close(seen(&scene, [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), [1.0, 0.5, 0.0]);
}

#[test]
fn a_shadow_falls_between_point_and_light_only() {
    let scene = lit_floor(Material { ambient: 0.25, diffuse: 1.0, ..dark() });
    let (lit, hidden) = ([1.25, 0.625, 0.0], [0.25, 0.125, 0.0]);
    let with = |sphere| {
        seen(&Scene { spheres: vec![sphere], ..scene.clone() }, [4.0, 3.0, 0.0], [-0.8, -0.6, 0.0])
    };
    assert_close(with(ball([0.0, 5.0, 0.0], 1.0, 0)), hidden);
    // Beyond the light, behind the point, beside.
    assert_close(with(ball([0.0, 12.0, 0.0], 1.0, 0)), lit);
    assert_close(with(ball([0.0, -2.0, 0.0], 1.0, 0)), lit);
    assert_close(with(ball([-2.0, 5.0, 0.0], 1.0, 0)), lit);
    // Its surface through the light, from beyond and from before it; through the point.
    assert_close(with(ball([0.0, 11.0, 0.0], 1.0, 0)), lit);
    assert_close(with(ball([0.0, 9.0, 0.0], 1.0, 0)), hidden);
    assert_close(with(ball([0.0, -1.0, 0.0], 1.0, 0)), lit);
    // Around point and light, around the light alone.
    assert_close(with(ball([0.0, 5.0, 0.0], 20.0, 0)), lit);
    assert_close(with(ball([0.0, 10.0, 0.0], 1.0, 0)), hidden);
}

#[test]
fn what_passes_through_the_point_or_the_light_hides_nothing() {
    let mut scene = lit_floor(Material { diffuse: 1.0, ..dark() });
    // A second floor in the same place, a wall across the point, a ceiling across the light.
    scene.planes.extend([
        floor(0),
        Plane { normal: DVec3::new(1.0, 2.0, 0.0), ..floor(0) },
        Plane { point: 10.0 * DVec3::Y, normal: DVec3::new(0.1, -0.7, 0.3), material: 0 },
    ]);
    scene.triangles = vec![Triangle { vertices: [-DVec3::X, DVec3::X, DVec3::Z], material: 0 }];
    assert_close(seen(&scene, [4.0, 3.0, 0.0], [-0.8, -0.6, 0.0]), [1.0, 0.5, 0.0]);
}

#[test]
fn ambient_is_there_once() {
    let mut scene = lit_floor(Material { ambient: 0.25, diffuse: 1.0, ..dark() });
    scene.spheres = vec![ball([0.0, 5.0, 0.0], 1.0, 0)];
    for lights in 0..4 {
        scene.lights = vec![lamp([0.0, 10.0, 0.0]); lights];
        assert_close(seen(&scene, [4.0, 3.0, 0.0], [-0.8, -0.6, 0.0]), [0.25, 0.125, 0.0]);
    }
}

#[test]
fn lights_add_up_and_are_not_clamped() {
    let mut scene = lit_floor(Material { diffuse: 1.0, ..dark() });
    scene.lights = vec![lamp([0.0, 10.0, 0.0]), Light { power: 1.5, ..lamp([0.0, 20.0, 0.0]) }];
    assert_close(seen(&scene, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]), [2.5, 1.25, 0.0]);
}

// Reflection

/// A mirror for a floor, a glowing green wall at x = 10.
fn mirror(reflection: f64, max_reflections: u32) -> Scene {
    let mut scene = empty();
    scene.render.max_reflections = max_reflections;
    scene.materials[RED].reflection = reflection;
    scene.planes =
        vec![floor(RED), Plane { point: 10.0 * DVec3::X, normal: DVec3::X, material: GREEN }];
    scene
}

#[test]
fn a_mirror_blends() {
    let look = |scene: &Scene| seen(scene, [-4.0, 3.0, 0.0], [0.8, -0.6, 0.0]);
    assert_close(look(&mirror(0.25, 4)), [0.75, 0.25, 0.0]);
    assert_close(look(&mirror(1.0, 1)), [0.0, 1.0, 0.0]);
    assert_close(look(&mirror(0.0, 4)), [1.0, 0.0, 0.0]);
    let away = Scene { planes: vec![floor(RED)], ..mirror(0.25, 4) };
    assert_close(look(&away), [0.875, 0.125, 0.125]);
}

#[test]
fn beyond_the_limit_a_mirror_is_black() {
    let look = |scene: &Scene| seen(scene, [-4.0, 3.0, 0.0], [0.8, -0.6, 0.0]);
    assert_close(look(&mirror(0.25, 0)), [0.75, 0.0, 0.0]);
    assert_close(look(&mirror(1.0, 0)), [0.0; 3]);
    assert_close(look(&mirror(0.0, 0)), [1.0, 0.0, 0.0]);
}

#[test]
fn between_two_mirrors() {
    // Up and down for ever: (1-k) (1 + k + k^2 + ...), cut off after `max_reflections`.
    for max_reflections in [0, 1, 2, 5, 64] {
        let mut scene = mirror(0.5, max_reflections);
        scene.planes = vec![floor(RED), Plane { point: DVec3::Y, ..floor(RED) }];
        let expected = 1.0 - 0.5f64.powi(max_reflections as i32 + 1);
        assert_close(seen(&scene, [0.0, 0.5, 0.0], [0.0, -1.0, 0.0]), [expected, 0.0, 0.0]);
    }
}

#[test]
fn a_mirrored_ray_leaves_the_point() {
    // Off the outside of a sphere at 45 degrees, to a wall; and inside one, across to the far side.
    let mut scene = mirror(1.0, 1);
    scene.planes.remove(0);
    scene.spheres = vec![ball([0.0; 3], 1.0, RED)];
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert_close(seen(&scene, [half, half + 5.0, 0.0], [0.0, -1.0, 0.0]), [0.0, 1.0, 0.0]);
    scene.render.max_reflections = 3;
    scene.materials[RED].reflection = 0.5;
    // Around a square: four hits, the last one's mirror beyond the limit.
    assert_close(
        seen(&scene, [half, 0.0, 0.0], [0.0, -1.0, 0.0]),
        [1.0 - 0.5f64.powi(4), 0.0, 0.0],
    );
}

// Anti-aliasing

#[test]
fn the_weights_of_the_filter() {
    let found = samples(1);
    assert_eq!(found.len(), 9);
    let (side, corner) = ((-1.0f64 / 0.64).exp(), (-2.0f64 / 0.64).exp());
    let total = 1.0 + 4.0 * side + 4.0 * corner;
    for sample in found {
        let expected = [1.0, side, corner][(sample.dx.abs() + sample.dy.abs()) as usize] / total;
        assert!((sample.weight - expected).abs() < 1e-15);
    }
    for density in 0..=32 {
        let found = samples(density);
        assert_eq!(found.len() as u32, (2 * density + 1).pow(2));
        assert!((found.iter().map(|sample| sample.weight).sum::<f64>() - 1.0).abs() < 1e-12);
        let reach = if density == 0 { 0.0 } else { 1.0 };
        for (bound, pick) in [(-reach, f64::min as fn(f64, f64) -> f64), (reach, f64::max)] {
            assert_eq!(found.iter().map(|sample| sample.dx).fold(0.0, pick), bound);
            assert_eq!(found.iter().map(|sample| sample.dy).fold(0.0, pick), bound);
        }
    }
}

#[test]
fn an_edge_through_a_pixel() {
    // The floor ends at a horizon through the middle of the only pixel: below it are the samples
    // with dy > 0; those on it are parallel to the floor and miss.
    let mut scene = Scene { planes: vec![Plane { point: -DVec3::Y, ..floor(RED) }], ..empty() };
    scene.render.background = DVec3::ZERO;
    scene.render.antialiasing = 2;
    let row = |dy: f64| (-dy * dy / 0.64).exp();
    let share = (row(0.5) + row(1.0)) / (row(0.0) + 2.0 * row(0.5) + 2.0 * row(1.0));
    assert_close(render(&scene, 1, 1)[0].into(), [share, 0.0, 0.0]);
}

#[test]
fn samples_outside_the_image_are_traced() {
    // The pixel sees only background; half of what is beyond its left edge is red.
    let mut scene = empty();
    scene.render = RenderSettings { background: DVec3::ZERO, antialiasing: 1, ..scene.render };
    // Sample columns lie at x = -2, 0 and 2 on the screen of 4 wide, at z = -2.
    scene.triangles = vec![Triangle {
        vertices: [[-1.5, -99.0, -1.0], [-1.5, 99.0, -1.0], [-0.9, 0.0, -1.0]]
            .map(DVec3::from_array),
        material: RED,
    }];
    scene.camera.screen_width = 4.0;
    let side = (-1.0f64 / 0.64).exp();
    // At z = -1 the left column is at x = -2: outside the triangle; at half the screen's width it
    // is at x = -1: inside, in all three rows.
    assert_close(render(&scene, 1, 1)[0].into(), [0.0; 3]);
    scene.camera.screen_width = 2.0;
    assert_close(render(&scene, 1, 1)[0].into(), [side / (1.0 + 2.0 * side), 0.0, 0.0]);
}

// All of it

#[test]
fn hits_lie_on_the_surface() {
    for seed in 0..300 {
        let scene = random_scene(seed);
        let model = Model::new(&scene);
        for (x, y) in [(0.5, 0.5), (1.3, 2.2), (2.0, 1.5), (3.7, 0.1)] {
            let ray = primary_ray(&scene.camera, x, y, 4, 3);
            let Some((t, primitive)) = model.first(&ray) else { continue };
            let point = ray.at(t);
            let size = 1.0 + point.length() + ray.origin.length();
            assert!(
                off_surface(primitive, point) < 1e-12 * size,
                "seed {seed}: {primitive:?} at {point}"
            );
            assert!(primitive.normal(point).is_normalized());
        }
    }
}

fn off_surface(primitive: &Primitive, point: DVec3) -> f64 {
    match primitive {
        Primitive::Plane(plane) => (point - plane.point).dot(plane.normal.normalize()).abs(),
        Primitive::Sphere(sphere) => (point.distance(sphere.center) - sphere.radius).abs(),
        Primitive::Cylinder(cylinder) => {
            let axis = DVec3 { y: point.y, ..cylinder.bottom };
            let beyond = (cylinder.bottom.y - point.y).max(point.y - cylinder.top.y).max(0.0);
            (point.distance(axis) - cylinder.radius).abs() + beyond
        }
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            // The areas of the three parts add up to the whole only within it.
            let rect = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a).length();
            let whole = rect(*a, *b, *c);
            (rect(point, *a, *b) + rect(point, *b, *c) + rect(point, *c, *a) - whole).abs()
                / whole.sqrt()
        }
    }
}

#[test]
fn random_images_are_finite_and_not_negative() {
    for seed in 0..100 {
        let image = render(&random_scene(seed), 6, 5);
        assert_eq!(image.len(), 30);
        assert!(image.as_flattened().iter().all(|c| c.is_finite() && *c >= 0.0), "seed {seed}");
    }
}
