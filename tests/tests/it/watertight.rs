//! A closed mesh has no leaks: a ray from inside meets some triangle, also where it goes through an
//! edge or a corner exactly.

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_core::Precision;
use rayweave_tests::meshes::{self, cube, scene_of};
use rayweave_tests::scenes::{PRECISIONS, caster};
use rayweave_tests::transform::{enlarged, moved};

/// Weights of a triangle's corners, which give a corner, a point of an edge or one of the face.
fn aim() -> impl Strategy<Value = [f64; 3]> {
    let share = || (0..=16i32).prop_map(|k| f64::from(k) / 16.0);
    prop_oneof![
        Just([1.0, 0.0, 0.0]),
        share().prop_map(|s| [1.0 - s, s, 0.0]),
        (share(), share()).prop_map(|(s, t)| [1.0 - s, s * (1.0 - t), s * t]),
    ]
}

/// A point well within each mesh: at most 5/8 from the middle.
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
        mesh in 0..4usize,
        triangle: prop::sample::Index,
        corner in 0..3usize,
        shares in aim(),
        from in inside(),
        exact: bool,
        scale in 0.001..1000.0f64,
        offset in prop_oneof![Just(DVec3::ZERO), inside().prop_map(|v| 200.0 * v)],
    ) {
        let (_, mesh) = &meshes::all()[mesh];
        let corners = triangle.get(mesh);
        let aim = (0..3).map(|i| shares[i] * corners[(corner + i) % 3]).sum::<DVec3>();
        let (scale, offset) = if exact { (1.0, DVec3::ZERO) } else { (scale, offset) };
        let scene = moved(&enlarged(&scene_of(mesh), scale), offset * scale);
        let origin = (from + offset) * scale;
        let direction = scale * (aim - from);
        for precision in PRECISIONS {
            let hit = caster(&scene, precision).closest_hit(origin, direction);
            prop_assert!(hit.is_some(), "{precision}: from {origin} along {direction}");
            // A leak to a triangle behind would be nearer or farther.
            let t = hit.map_or(0.0, |hit| hit.t);
            prop_assert!(
                (t - 1.0).abs() < 1e-3,
                "{precision}: t = {t} from {origin} along {direction}"
            );
        }
    }
}

/// Catches a mesh that is not closed, or not the one meant: every edge belongs to two triangles.
#[test]
fn the_meshes_are_closed() {
    let sizes = meshes::all().map(|(name, mesh)| {
        for (i, triangle) in mesh.iter().enumerate() {
            for edge in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|end| triangle[end])) {
                let shares = |other: &&[DVec3; 3]| edge.iter().all(|end| other.contains(end));
                assert_eq!(mesh.iter().filter(shares).count(), 2, "{name}, triangle {i}: {edge:?}");
            }
        }
        mesh.len()
    });
    assert_eq!(sizes, [12, 20, 80, 320]);
}

/// Catches the same where all numbers are small and whole, and products of them are equal: the
/// corners, the edges' and the faces' middles of a cube from points on its axes and diagonals.
#[test]
fn no_ray_leaves_a_cube_through_its_symmetries() {
    let scene = scene_of(&cube());
    let steps = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let grid = || {
        steps.into_iter().flat_map(move |x| {
            steps.into_iter().flat_map(move |y| steps.map(|z| DVec3::new(x, y, z)))
        })
    };
    for from in grid().map(|point| 0.5 * point) {
        for aim in grid().filter(|point| point.abs().max_element() == 1.0) {
            for precision in PRECISIONS {
                let hit = caster(&scene, precision).closest_hit(from, aim - from);
                let hit =
                    hit.unwrap_or_else(|| panic!("{precision}: from {from} to {aim}: a leak"));
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
            for (aside, hits) in
                [(DVec3::new(10.0, -10.0, 4.0), true), (DVec3::new(-10.0, 10.0, 4.0), false)]
            {
                for vertices in [[from, to, aside], [to, from, aside], [aside, from, to]] {
                    let hit = caster(&scene_of(&[vertices]), precision)
                        .closest_hit(DVec3::ZERO, DVec3::Z);
                    assert_eq!(hit.is_some(), hits, "{precision}: {vertices:?}");
                }
            }
        }
    }
}
