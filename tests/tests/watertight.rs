//! A closed mesh has no leaks: a ray from inside meets some triangle, also where it goes through an
//! edge or a corner to the last bit.

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_core::scene::Triangle;
use rayweave_core::{Caster, Precision, Scene};
use rayweave_tests::errata;
use rayweave_tests::transform::{enlarged, moved};

/// Twelve triangles around the origin, whose corners are exact.
fn cube() -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for (normal, side) in [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X)] {
        for normal in [normal, -normal] {
            let up = normal.cross(side);
            let corner = |right: f64, above: f64| normal + right * side + above * up;
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

/// Twenty triangles around the origin, five at each corner, whose corners are not exact.
fn icosahedron() -> Vec<[DVec3; 3]> {
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    let mut corners = Vec::new();
    for (long, short) in [(golden, 1.0), (golden, -1.0), (-golden, 1.0), (-golden, -1.0)] {
        corners.extend([
            DVec3::new(0.0, short, long),
            DVec3::new(short, long, 0.0),
            DVec3::new(long, 0.0, short),
        ]);
    }
    // All edges are 2 long, the next longer distance is more than 3.
    let neighbours = |a: DVec3, b: DVec3| (a.distance(b) - 2.0).abs() < 0.1;
    let mut triangles = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        for (j, &b) in corners.iter().enumerate().skip(i + 1) {
            let rest = corners.iter().skip(j + 1);
            let thirds = rest.filter(|&&c| neighbours(a, b) && neighbours(b, c) && neighbours(c, a));
            triangles.extend(thirds.map(|&c| [a, b, c]));
        }
    }
    triangles
}

/// A corner where many triangles meet: a cone of `corners` sides with its base.
fn cone(corners: u32) -> Vec<[DVec3; 3]> {
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k % corners) / f64::from(corners));
        DVec3::new(2.0 * cos, -1.0, 2.0 * sin)
    };
    let (tip, middle) = (2.0 * DVec3::Y, -DVec3::Y);
    (0..corners).flat_map(|k| [tip, middle].map(|end| [end, corner(k), corner(k + 1)])).collect()
}

fn meshes() -> [Vec<[DVec3; 3]>; 3] {
    let meshes = [cube(), icosahedron(), cone(40)];
    assert_eq!([12, 20, 80], [0, 1, 2].map(|i| meshes[i].len()));
    meshes
}

fn scene_of(mesh: &[[DVec3; 3]]) -> Scene {
    let triangles = mesh.iter().map(|&vertices| Triangle { vertices, material: 0 }).collect();
    Scene { triangles, ..errata::shadings().swap_remove(0).scene }
}

fn caster(scene: &Scene, precision: Precision) -> Caster {
    Caster::new(scene, precision).expect("a sound scene")
}

/// Where a ray is aimed: at a corner, a point of an edge or one of a face, of some triangle.
fn aim() -> impl Strategy<Value = [f64; 3]> {
    let share = || (0..=16i32).prop_map(|k| f64::from(k) / 16.0);
    prop_oneof![
        Just([1.0, 0.0, 0.0]),
        share().prop_map(|s| [1.0 - s, s, 0.0]),
        (share(), share()).prop_map(|(s, t)| [1.0 - s, s * (1.0 - t), s * t]),
    ]
}

/// Well within each mesh: at most 5/8 from the middle.
fn inside() -> impl Strategy<Value = DVec3> {
    let coordinate = || prop_oneof![Just(0.0), (-92..=92i32).prop_map(|k| f64::from(k) / 256.0)];
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 5000,
        rng_seed: RngSeed::Fixed(2025),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Catches an edge test that is strict, that is another from the neighbour's side, or whose
    /// zero is not the exact one; and a corner that belongs to no triangle.
    #[test]
    fn no_ray_leaves_a_closed_mesh(
        mesh in 0..3usize,
        triangle: prop::sample::Index,
        corner in 0..3usize,
        shares in aim(),
        from in inside(),
        exact: bool,
        scale in 0.001..1000.0f64,
        offset in prop_oneof![Just(DVec3::ZERO), inside().prop_map(|v| 200.0 * v)],
    ) {
        let mesh = &meshes()[mesh];
        let corners = triangle.get(mesh);
        let aim = (0..3).map(|i| shares[i] * corners[(corner + i) % 3]).sum::<DVec3>();
        let (scale, offset) = if exact { (1.0, DVec3::ZERO) } else { (scale, offset) };
        let scene = moved(&enlarged(&scene_of(mesh), scale), offset * scale);
        let origin = (from + offset) * scale;
        let direction = scale * (aim - from);
        for precision in [Precision::F32, Precision::F64] {
            let hit = caster(&scene, precision).nearest_hit(origin, direction);
            prop_assert!(hit.is_some(), "{precision}: from {origin} along {direction}");
            // A leak to a triangle behind would be nearer or farther.
            let t = hit.map_or(0.0, |hit| hit.t);
            prop_assert!((t - 1.0).abs() < 1e-3, "{precision}: t = {t} from {origin} along {direction}");
        }
    }
}

/// Catches the same where all numbers are small and whole, and products of them are equal: the
/// corners, the edges' and the faces' middles of a cube from points on its axes and diagonals.
#[test]
fn no_ray_leaves_a_cube_through_its_symmetries() {
    let scene = scene_of(&cube());
    let steps = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let grid = || {
        steps
            .into_iter()
            .flat_map(move |x| steps.into_iter().flat_map(move |y| steps.map(|z| DVec3::new(x, y, z))))
    };
    for from in grid().map(|point| 0.5 * point) {
        for aim in grid().filter(|point| point.abs().max_element() == 1.0) {
            for precision in [Precision::F32, Precision::F64] {
                let hit = caster(&scene, precision).nearest_hit(from, aim - from);
                let hit = hit.unwrap_or_else(|| panic!("{precision}: from {from} to {aim}: a leak"));
                assert!((hit.t - 1.0).abs() < 1e-6, "{precision}: from {from} to {aim}: {hit:?}");
            }
        }
    }
}

/// Catches an edge test that calls equal what rounding made equal: of two triangles that meet in an
/// edge, a ray that passes it by less than the products' last digit hits the one on its side.
#[test]
fn a_ray_beside_an_edge_hits_one_side() {
    // The edge passes the z axis at 2^-26 and 2^-54: (1 + e) (1 - e) and 1 are rounded to the same.
    for (precision, e) in [(Precision::F32, 2f64.powi(-13)), (Precision::F64, 2f64.powi(-27))] {
        for sign in [1.0, -1.0] {
            let from = DVec3::new(1.0 + sign * e, 1.0, 4.0);
            let to = DVec3::new(-1.0, -(1.0 - sign * e), 4.0);
            for (aside, hits) in [(DVec3::new(10.0, -10.0, 4.0), true), (DVec3::new(-10.0, 10.0, 4.0), false)]
            {
                for vertices in [[from, to, aside], [to, from, aside], [aside, from, to]] {
                    let hit = caster(&scene_of(&[vertices]), precision).nearest_hit(DVec3::ZERO, DVec3::Z);
                    assert_eq!(hit.is_some(), hits, "{precision}: {vertices:?}");
                }
            }
        }
    }
}
