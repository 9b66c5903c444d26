//! The model that the tracer is compared with, against values worked out by hand; `errata` has
//! more.

use crate::geometry::{beyond_edge, off_surface};
use glam::{DVec3, dvec3 as v};
use rayweave_core::Scene;
use rayweave_core::scene::{Camera, Light, Material, RenderSettings};
use rayweave_tests::model::{Model, Primitive, Ray, primary_ray, render, samples};
use rayweave_tests::random_scene::random_scene;
use rayweave_tests::scenes::{cylinder, light, looking, plane, sphere, triangle, with};

const RED: usize = 0;
const GREEN: usize = 1;
const BLUE: usize = 2;

/// A scene without primitives and lights, with three materials that are visible without light and a
/// grey background.
fn empty() -> Scene {
    let glowing =
        |color| Material { ambient: 1.0, diffuse: 0.0, specular: 0.0, ..Material::new(color) };
    let mut scene = looking(DVec3::ZERO, -DVec3::Z, &[]);
    scene.camera = Camera { focal_length: 2.0, screen_width: 4.0, ..scene.camera };
    scene.render =
        RenderSettings { background: DVec3::splat(0.5), max_reflections: 4, ..scene.render };
    scene.materials = [DVec3::X, DVec3::Y, DVec3::Z].map(glowing).to_vec();
    scene
}

fn of<const N: usize>(primitives: [Primitive; N]) -> Scene {
    with(empty(), primitives)
}

/// The colour that a ray brings.
fn seen(scene: &Scene, origin: DVec3, direction: DVec3) -> DVec3 {
    assert_eq!(scene.check(), Ok(()));
    Model::new(scene).trace(&Ray { origin, direction: direction.normalize() }, 0.0, 0)
}

fn floor() -> Primitive {
    plane(DVec3::ZERO, DVec3::Y)
}

#[track_caller]
fn assert_close(found: DVec3, expected: DVec3) {
    assert!(found.distance(expected) < 1e-12, "{found} instead of {expected}");
}

// Camera

/// Catches a basis that is not orthonormal, or an axis with the wrong sign.
#[test]
fn the_screen_is_where_it_belongs() {
    let tilted = Camera {
        position: v(1.0, 2.0, 3.0),
        look_at: v(4.0, 6.0, 3.0),
        up: v(0.0, 0.0, 7.0),
        focal_length: 0.3,
        screen_width: 5.0,
    };
    assert_eq!(primary_ray(&tilted, 2.0, 1.5, 4, 3).origin, tilted.position);
    // To -z, 2 away, 4 wide and so 3 high; to the right is +x, up is +y.
    let ahead = empty().camera;
    // Straight down: the top of the image is to -z, its right to +x.
    let down = Camera { look_at: -DVec3::Y, up: v(0.0, 5.0, -0.2), ..ahead };
    for (camera, (x, y), size, through) in [
        (tilted, (2.0, 1.5), (4, 3), v(0.6, 0.8, 0.0)),
        (ahead, (0.0, 0.0), (8, 6), v(-2.0, 1.5, -2.0)),
        (ahead, (8.0, 6.0), (8, 6), v(2.0, -1.5, -2.0)),
        // The centre of pixel (0, 0), the top left one.
        (ahead, (0.5, 0.5), (8, 6), v(-1.75, 1.25, -2.0)),
        (down, (8.0, 0.0), (8, 8), v(2.0, -2.0, -2.0)),
    ] {
        assert_close(primary_ray(&camera, x, y, size.0, size.1).direction, through.normalize());
    }
}

/// Catches rows from the bottom, and a near clipping plane at the screen.
#[test]
fn whole_images() {
    let image = render(&of([plane(-DVec3::Y, DVec3::Y)]), 2, 2);
    assert_eq!(image, [[0.5; 3], [0.5; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let before_the_screen = sphere(v(0.0, 0.0, -1.0), 0.1);
    assert_eq!(render(&of([before_the_screen]), 1, 1), [[1.0, 0.0, 0.0]]);
    assert_eq!(render(&empty(), 2, 1), [[0.5; 3]; 2]);
}

// Closest hit

/// Catches a wrong root, one that is left out because it is behind, and a tangent or a rim that
/// does not belong to the surface.
#[test]
fn roots_on_either_side() {
    let along_z =
        |radius| [sphere(v(3.0, 4.0, 9.0), radius), cylinder(v(5.0, -1.0, 9.0), 2.0, radius)];
    let [ball, tube] = [sphere(v(0.0, 0.0, -5.0), 2.0), cylinder(DVec3::ZERO, 1.0, 1.0)];
    let [tangents, beside] = [along_z(5.0), along_z(4.999)];
    for (primitive, origin, direction, roots) in [
        (ball, DVec3::ZERO, -DVec3::Z, [Some(3.0), Some(7.0)]),
        (ball, DVec3::ZERO, -2.0 * DVec3::Z, [Some(1.5), Some(3.5)]),
        (ball, v(0.0, 0.0, -6.0), -DVec3::Z, [Some(-3.0), Some(1.0)]),
        (tangents[0], DVec3::ZERO, DVec3::Z, [Some(9.0); 2]),
        (tangents[1], DVec3::ZERO, DVec3::Z, [Some(9.0); 2]),
        (beside[0], DVec3::ZERO, DVec3::Z, [None; 2]),
        (beside[1], DVec3::ZERO, DVec3::Z, [None; 2]),
        (tube, v(-3.0, 0.0, 0.0), DVec3::X, [Some(2.0), Some(4.0)]),
        (tube, v(-3.0, 1.0, 0.0), DVec3::X, [Some(2.0), Some(4.0)]),
        (tube, v(-3.0, -0.001, 0.0), DVec3::X, [None; 2]),
        (tube, v(-3.0, 1.001, 0.0), DVec3::X, [None; 2]),
    ] {
        assert_eq!(primitive.roots(&Ray { origin, direction }), roots, "{primitive:?}");
    }
}

/// Catches an edge or corner that does not belong to the triangle, in either orientation.
#[test]
fn a_triangle_includes_its_edges_and_corners() {
    let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for triangle in [[a, b, c], [a, c, b]].map(triangle) {
        let at = |(x, y)| triangle.hit(&Ray { origin: v(x, y, 2.0), direction: -DVec3::Z });
        for on in
            [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.0, 0.5), (0.5, 0.0), (0.25, 0.25)]
        {
            assert_eq!(at(on), Some(2.0), "{on:?}");
        }
        for off in [(-0.001, 0.5), (0.5, -0.001), (0.501, 0.5), (1.001, 0.0), (-1.0, -1.0)] {
            assert_eq!(at(off), None, "{off:?}");
        }
    }
}

/// Catches a hit behind the ray's origin, and one at `t = 0`, where the other root is the hit.
#[test]
fn the_closest_hit_is_in_front() {
    let [behind, ahead] = [v(0.0, 0.0, 3.0), v(0.0, 0.0, -9.0)].map(|center| sphere(center, 1.0));
    let wall = plane(v(0.0, 0.0, -20.0), DVec3::Z);
    let scene = of([behind, ahead.of(GREEN), wall.of(BLUE)]);
    assert_eq!(seen(&scene, DVec3::ZERO, -DVec3::Z), DVec3::Y);
    assert_eq!(seen(&scene, DVec3::ZERO, v(1.0, 0.0, -1.0)), DVec3::Z);
    let background = DVec3::splat(0.5);
    assert_eq!(seen(&of([floor()]), DVec3::Y, v(1.0, 0.1, 0.0)), background);
    let start = of([sphere(DVec3::ZERO, 1.0), floor().of(GREEN)]);
    assert_eq!(seen(&start, DVec3::ZERO, DVec3::Y), DVec3::X);
    assert_eq!(seen(&start, DVec3::X, -DVec3::X), DVec3::X);
    assert_eq!(seen(&start, DVec3::X, v(1.0, 0.1, 0.0)), background);
}

/// Catches another order between kinds, or within one. Along -z all four kinds are at `t = 2`.
#[test]
fn equal_distances_go_to_the_first_kind_then_to_the_first_in_the_file() {
    let corners = [v(-1.0, -1.0, -2.0), v(1.0, -1.0, -2.0), v(0.0, 1.0, -2.0)];
    let mut scene = empty();
    for (primitive, first, color) in [
        (cylinder(v(0.0, -1.0, -3.0), 2.0, 1.0), RED, DVec3::X),
        (triangle(corners), GREEN, DVec3::Y),
        (sphere(v(0.0, 0.0, -3.0), 1.0), RED, DVec3::X),
        (plane(v(0.0, 0.0, -2.0), DVec3::Z), GREEN, DVec3::Y),
    ] {
        scene = with(scene, [primitive.of(first), primitive.of(BLUE)]);
        assert_eq!(seen(&scene, DVec3::ZERO, -DVec3::Z), color);
    }
}

// Shading

/// These primitives, of this material, under these lights.
fn lit<const N: usize>(primitives: [Primitive; N], lights: &[DVec3], material: Material) -> Scene {
    let lights = lights.iter().copied().map(light).collect();
    with(Scene { materials: vec![material], lights, ..empty() }, primitives)
}

/// A floor of this material under a light at (0, 10, 0).
fn lit_floor(material: Material) -> Scene {
    lit([floor()], &[v(0.0, 10.0, 0.0)], material)
}

/// A material of which everything is 0 but the colour, which is (1, 1/2, 0).
fn dark() -> Material {
    Material { ambient: 0.0, diffuse: 0.0, specular: 0.0, ..Material::new(COLOR) }
}

fn matt() -> Material {
    Material { diffuse: 1.0, ..dark() }
}

const COLOR: DVec3 = v(1.0, 0.5, 0.0);

/// Catches a term or a factor that is left out, in a channel or in all.
#[test]
fn a_lit_point() {
    // At (7.5, 0, 0): l = (-.6, .8, 0), n.l = .8, m = (.6, .8, 0). Seen along (-.8, -.6, 0), so
    // m.-d = .48 + .48 = .96.
    let mut scene =
        lit_floor(Material { ambient: 0.25, diffuse: 0.5, specular: 0.75, shininess: 3, ..dark() });
    scene.lights[0] = Light { color: v(1.0, 0.5, 0.25), power: 2.0, ..scene.lights[0] };
    let highlight = 0.75 * 0.96f64.powi(3);
    let expected = v(
        0.25 * 1.0 + 2.0 * 1.0 * (0.5 * 0.8 * 1.0 + highlight),
        0.25 * 0.5 + 2.0 * 0.5 * (0.5 * 0.8 * 0.5 + highlight),
        0.25 * 0.0 + 2.0 * 0.25 * (0.5 * 0.8 * 0.0 + highlight),
    );
    assert_close(seen(&scene, v(15.5, 6.0, 0.0), v(-0.8, -0.6, 0.0)), expected);
}

/// Catches a highlight on the wrong side of the point of `a_lit_point`: from the left m.-d is
/// -.48 + .48 = 0 along (.8, -.6), and below 0 farther down.
#[test]
fn a_highlight_is_on_one_side() {
    let scene = lit_floor(Material { specular: 1.0, shininess: 1, ..dark() });
    assert_close(seen(&scene, v(7.5 - 8.0, 6.0, 0.0), v(0.8, -0.6, 0.0)), DVec3::ZERO);
    assert_close(seen(&scene, v(7.5 - 9.0, 1.0, 0.0), v(9.0, -1.0, 0.0)), DVec3::ZERO);
    assert_close(seen(&scene, v(7.5 + 3.0, 4.0, 0.0), v(-0.6, -0.8, 0.0)), DVec3::ONE);
}

/// Catches a light in the surface, or at the point itself, that gives something.
#[test]
fn a_light_in_the_surface_gives_nothing() {
    for light in [4.0 * DVec3::X, DVec3::ZERO] {
        let scene = lit([floor()], &[light], Material { specular: 1.0, ..matt() });
        assert_eq!(seen(&scene, v(-4.0, 3.0, 0.0), v(0.8, -0.6, 0.0)), DVec3::ZERO);
    }
}

/// Catches a surface with one side, and a light that shines through a wall or not over a rim.
#[test]
fn surfaces_are_two_sided() {
    let from_below = (v(0.0, -1.0, 0.0), DVec3::Y);
    // The far wall's normal is (-1, 0, 0), and the first light straight before it.
    let into_tube = (v(-3.0, 2.5, 0.0), v(2.0, -1.0, 0.0));
    let (tube, ball) = (cylinder(DVec3::ZERO, 1.0, 1.0), sphere(DVec3::ZERO, 2.0));
    for (primitive, lights, (origin, direction), brightness) in [
        (floor(), &[v(0.0, -10.0, 0.0)][..], from_below, 1.0),
        (plane(DVec3::ZERO, -5.0 * DVec3::Y), &[v(0.0, -10.0, 0.0)], from_below, 1.0),
        (tube, &[v(-0.5, 0.5, 0.0), v(5.0, 0.5, 0.0)], into_tube, 1.0),
        // Beyond the near wall, and over the rim.
        (tube, &[v(-5.0, 0.5, 0.0)], into_tube, 0.0),
        (tube, &[v(-2.0, 4.5, 0.0)], into_tube, 0.6),
        (ball, &[DVec3::ZERO, v(0.0, 0.0, 9.0)], (DVec3::Z, -DVec3::Z), 1.0),
    ] {
        assert_close(
            seen(&lit([primitive], lights, matt()), origin, direction),
            brightness * COLOR,
        );
    }
}

/// Catches a shadow of a surface that is not between point and light.
#[test]
fn a_shadow_falls_between_point_and_light_only() {
    let scene = lit_floor(Material { ambient: 0.25, ..matt() });
    for (center, radius, brightness) in [
        (v(0.0, 5.0, 0.0), 1.0, 0.25),
        // Beyond the light, behind the point, beside.
        (v(0.0, 12.0, 0.0), 1.0, 1.25),
        (v(0.0, -2.0, 0.0), 1.0, 1.25),
        (v(-2.0, 5.0, 0.0), 1.0, 1.25),
        // Its surface through the light, from beyond and from before it; through the point.
        (v(0.0, 11.0, 0.0), 1.0, 1.25),
        (v(0.0, 9.0, 0.0), 1.0, 0.25),
        (v(0.0, -1.0, 0.0), 1.0, 1.25),
        // Around point and light, around the light alone.
        (v(0.0, 5.0, 0.0), 20.0, 1.25),
        (v(0.0, 10.0, 0.0), 1.0, 0.25),
    ] {
        let scene = with(scene.clone(), [sphere(center, radius)]);
        let found = seen(&scene, v(4.0, 3.0, 0.0), v(-0.8, -0.6, 0.0));
        assert_close(found, brightness * COLOR);
    }
}

/// Catches a shadow of a surface through the point or the light: a second floor in the same place,
/// walls across the point, a ceiling across the light.
#[test]
fn a_surface_through_the_point_or_the_light_hides_nothing() {
    let across = [
        floor(),
        plane(DVec3::ZERO, v(1.0, 2.0, 0.0)),
        plane(10.0 * DVec3::Y, v(0.1, -0.7, 0.3)),
        triangle([-DVec3::X, DVec3::X, DVec3::Z]),
    ];
    let scene = with(lit_floor(matt()), across);
    assert_close(seen(&scene, v(4.0, 3.0, 0.0), v(-0.8, -0.6, 0.0)), COLOR);
}

/// Catches a sum of lights that is clamped.
#[test]
fn lights_add_up() {
    let mut scene = lit([floor()], &[v(0.0, 10.0, 0.0), v(0.0, 20.0, 0.0)], matt());
    scene.lights[1].power = 1.5;
    assert_close(seen(&scene, DVec3::Y, -DVec3::Y), 2.5 * COLOR);
}

// Reflection

/// These primitives, of which the red ones are mirrors.
fn mirror<const N: usize>(primitives: [Primitive; N], share: f64, max_reflections: u32) -> Scene {
    let mut scene = of(primitives);
    scene.render.max_reflections = max_reflections;
    scene.materials[RED].reflection = share;
    scene
}

/// Catches a mirror that blends by another share, or is not black beyond the limit. Its ray goes to
/// a green wall at x = 10.
#[test]
fn a_mirror_blends() {
    let wall = plane(10.0 * DVec3::X, DVec3::X).of(GREEN);
    let look = |scene: &Scene| seen(scene, v(-4.0, 3.0, 0.0), v(0.8, -0.6, 0.0));
    for (share, max_reflections, red, green) in [
        (0.25, 4, 0.75, 0.25),
        (1.0, 1, 0.0, 1.0),
        (0.0, 4, 1.0, 0.0),
        (0.25, 0, 0.75, 0.0),
        (1.0, 0, 0.0, 0.0),
        (0.0, 0, 1.0, 0.0),
    ] {
        let found = look(&mirror([floor(), wall], share, max_reflections));
        assert_close(found, v(red, green, 0.0));
    }
    assert_close(look(&mirror([floor()], 0.25, 4)), v(0.875, 0.125, 0.125));
}

/// Catches a mirror too many or too few. Up and down for ever is (1-k) (1 + k + k^2 + ...), cut off
/// after `max_reflections`.
#[test]
fn between_two_mirrors() {
    for max_reflections in [0, 1, 2, 5, 64] {
        let scene = mirror([floor(), plane(DVec3::Y, DVec3::Y)], 0.5, max_reflections);
        let expected = 1.0 - 0.5f64.powi(max_reflections as i32 + 1);
        assert_close(seen(&scene, 0.5 * DVec3::Y, -DVec3::Y), expected * DVec3::X);
    }
}

/// Catches a mirrored ray that stays at its point: off the outside of a sphere at 45 degrees, to a
/// wall; and inside of it around a square, four hits, of which the last one's mirror is beyond the
/// limit.
#[test]
fn a_mirrored_ray_leaves_the_point() {
    let wall = plane(10.0 * DVec3::X, DVec3::X).of(GREEN);
    let all = [wall, sphere(DVec3::ZERO, 1.0)];
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert_close(seen(&mirror(all, 1.0, 1), v(half, half + 5.0, 0.0), -DVec3::Y), DVec3::Y);
    let inside = seen(&mirror(all, 0.5, 3), v(half, 0.0, 0.0), -DVec3::Y);
    assert_close(inside, v(1.0 - 0.5f64.powi(4), 0.0, 0.0));
}

// Anti-aliasing

/// Catches weights that are not the Gaussian's, do not add up to 1, or reach another distance.
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

/// Catches a sample in the wrong row. The floor ends at a horizon through the middle of the only
/// pixel: the samples with dy > 0 are below it; those on it are parallel to the floor and miss.
#[test]
fn an_edge_through_a_pixel() {
    let mut scene = of([plane(-DVec3::Y, DVec3::Y)]);
    scene.render = RenderSettings { background: DVec3::ZERO, antialiasing: 2, ..scene.render };
    let row = |dy: f64| (-dy * dy / 0.64).exp();
    let share = (row(0.5) + row(1.0)) / (row(0.0) + 2.0 * row(0.5) + 2.0 * row(1.0));
    assert_close(render(&scene, 1, 1)[0].into(), share * DVec3::X);
}

/// Catches samples beyond the image that are left out. Sample columns lie at x = -2, 0 and 2 on the
/// screen of 4 wide, at z = -2.
#[test]
fn samples_outside_the_image_are_traced() {
    let mut scene = of([triangle([v(-1.5, -99.0, -1.0), v(-1.5, 99.0, -1.0), v(-0.9, 0.0, -1.0)])]);
    scene.render = RenderSettings { background: DVec3::ZERO, antialiasing: 1, ..scene.render };
    let side = (-1.0f64 / 0.64).exp();
    // At z = -1 the left column is at x = -2: outside the triangle; at half the screen's width it
    // is at x = -1: inside, in all three rows.
    assert_close(render(&scene, 1, 1)[0].into(), DVec3::ZERO);
    scene.camera.screen_width = 2.0;
    assert_close(render(&scene, 1, 1)[0].into(), side / (1.0 + 2.0 * side) * DVec3::X);
}

// All of it

/// Catches a root that is not on the surface, and a normal that is not unit.
#[test]
fn hits_lie_on_the_surface() {
    for seed in 0..300 {
        let scene = random_scene(seed);
        let model = Model::new(&scene);
        for (x, y) in [(0.5, 0.5), (1.3, 2.2), (2.0, 1.5), (3.7, 0.1)] {
            let ray = primary_ray(&scene.camera, x, y, 4, 3);
            let Some((t, primitive)) = model.nearest(&ray, 0.0) else { continue };
            let point = ray.at(t);
            let size = 1.0 + point.length() + ray.origin.length();
            let off = off_surface(primitive, point).max(beyond_edge(primitive, point));
            assert!(off < 1e-12 * size, "seed {seed}: {primitive:?} at {point}");
            assert!(primitive.normal(point).is_normalized());
        }
    }
}

/// Catches a NaN, an infinity and a negative colour.
#[test]
fn random_images_are_finite_and_not_negative() {
    for seed in 0..100 {
        let image = render(&random_scene(seed), 6, 5);
        assert_eq!(image.len(), 30);
        assert!(image.as_flattened().iter().all(|c| c.is_finite() && *c >= 0.0), "seed {seed}");
    }
}
