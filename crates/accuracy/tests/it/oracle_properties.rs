//! The robust kernel against the exact oracle, in f64 and f32, on random and on structured input:
//! it keeps what `rayweave_accuracy::guarantees` says.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_accuracy::{Primitive, Ray, guarantees, oracle};

/// A multiple of 1/16, with so few bits that products of several do not round: corners, edges,
/// tangents and parallels are met exactly.
fn fraction() -> impl Strategy<Value = f32> {
    (-64..=64i8).prop_map(|k| f32::from(k) / 16.0)
}

/// Where on the way from one end of something to the other: anywhere, at an end, or just beside
/// one.
fn share() -> impl Strategy<Value = f32> {
    let beside = (any::<bool>(), any::<bool>(), 4..24i32).prop_map(|(at_end, beyond, exponent)| {
        f32::from(u8::from(at_end))
            + if beyond { 2f32.powi(-exponent) } else { -2f32.powi(-exponent) }
    });
    prop_oneof![fraction().prop_map(|k| k / 4.0), beside]
}

/// Of a size near 2^-12 to 2^12, either sign.
fn sized() -> impl Strategy<Value = f32> {
    (-12..12i32, 1.0..2.0f32, any::<bool>())
        .prop_map(|(exponent, size, up)| 2f32.powi(exponent) * if up { size } else { -size })
}

/// Of any finite size, subnormal and huge ones now and then.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        60 => fraction(),
        60 => -8.0..8.0f32,
        60 => sized(),
        1 => prop::num::f32::NORMAL | prop::num::f32::SUBNORMAL,
    ]
}

fn vector() -> impl Strategy<Value = [f32; 3]> {
    [number(), number(), number()]
}

/// Where a ray starts and goes, and where that and the primitive are.
#[derive(Clone, Debug)]
struct Setting {
    origin: [f32; 3],
    /// If not to the point aimed at.
    direction: Option<[f32; 3]>,
    /// Added to all positions. Those are rounded then, and the ray passes what it was aimed at by
    /// so much.
    place: [f32; 3],
}

fn setting() -> impl Strategy<Value = Setting> {
    let place = prop_oneof![Just([0.0; 3]), [sized(), sized(), sized()]];
    (vector(), prop::option::weighted(0.25, vector()), place)
        .prop_map(|(origin, direction, place)| Setting { origin, direction, place })
}

fn moved(point: [f32; 3], way: [f32; 3], times: f32) -> [f32; 3] {
    std::array::from_fn(|i| point[i] + way[i] * times)
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Checks the primitive whose positions are put through the function that it is given.
fn check(
    primitive: impl FnOnce(&dyn Fn([f32; 3]) -> [f32; 3]) -> Primitive,
    setting: &Setting,
    aim: [f32; 3],
) -> Result<(), TestCaseError> {
    let Setting { origin, direction, place } = *setting;
    let put = |position| moved(position, place, 1.0);
    let ray = Ray { origin: put(origin), direction: direction.unwrap_or(difference(aim, origin)) };
    guarantees::check(&primitive(&put), &ray)
        .map_err(|violation| TestCaseError::fail(violation.to_string()))
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 30_000,
        rng_seed: RngSeed::Fixed(2025),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    /// Catches a plane with one side, one that is hit behind the ray, and heights that are not
    /// differences.
    #[test]
    fn planes_are_hit_where_they_are(
        point in vector(),
        normal in vector(),
        aside in [fraction(), fraction()],
        setting in setting(),
    ) {
        // Two ways at a right angle to the normal.
        let [x, y, z] = normal;
        let aim = moved(moved(point, [y, -x, 0.0], aside[0]), [0.0, z, -y], aside[1]);
        check(|put| Primitive::Plane { point: put(point), normal }, &setting, aim)?;
    }

    /// Catches the wrong root, a root lost from inside, and a discriminant that cancels.
    #[test]
    fn spheres_are_hit_where_they_are(
        center in vector(),
        radius in number().prop_map(f32::abs),
        outward in [fraction(), fraction(), fraction()],
        reach in share(),
        setting in setting(),
    ) {
        // On the surface, within or beside.
        let length = outward.iter().map(|x| x * x).sum::<f32>().sqrt().max(1.0 / 16.0);
        let aim = moved(center, outward, reach * radius / length);
        check(|put| Primitive::Sphere { center: put(center), radius }, &setting, aim)?;
    }

    /// Catches a back that is not hit, an edge with the wrong sign, and corners or distances that
    /// are not differences.
    #[test]
    fn triangles_are_hit_where_they_are(
        corners in [vector(), vector(), vector()],
        shares in [share(), share()],
        setting in setting(),
    ) {
        let [a, b, c] = corners;
        // Of the plane: at a corner, on an edge or just beside, within or outside.
        let aim = moved(moved(a, difference(b, a), shares[0]), difference(c, a), shares[1]);
        check(|put| Primitive::Triangle { a: put(a), b: put(b), c: put(c) }, &setting, aim)?;
    }

    /// Catches a far wall that is not seen through the open end, heights that are not differences,
    /// caps, and a discriminant that cancels.
    #[test]
    fn cylinders_are_hit_where_they_are(
        bottom in vector(),
        height in number(),
        radius in number().prop_map(f32::abs),
        outward in [fraction(), fraction()],
        share in share(),
        setting in setting(),
    ) {
        let top = moved(bottom, [0.0, height.abs(), 0.0], 1.0);
        let length = outward[0].hypot(outward[1]).max(1.0 / 16.0);
        let aside = moved(bottom, [outward[0], 0.0, outward[1]], radius / length);
        let aim = moved(aside, difference(top, bottom), share);
        check(|put| Primitive::Cylinder { bottom: put(bottom), top: put(top), radius }, &setting, aim)?;
    }
}

/// Some numbers, those of a ray last, and the primitive that the others are.
type Kind = (&'static [f32], fn(&[f32]) -> Primitive);

/// One primitive of each kind, hit by its ray.
const KINDS: [Kind; 4] = [
    (&[0.0, 1.0, 2.0, 0.5, 0.25, 1.0, 0.5, 0.25, -3.0, 0.125, 0.25, 1.0], |n| Primitive::Plane {
        point: triple(&n[..3]),
        normal: triple(&n[3..]),
    }),
    (&[0.5, 0.0, 1.0, 1.5, 0.5, 0.25, -3.0, 0.125, 0.25, 1.0], |n| Primitive::Sphere {
        center: triple(&n[..3]),
        radius: n[3],
    }),
    (&[-3.0, -2.0, 1.0, 4.0, -1.0, 0.5, 0.0, 5.0, 2.0, 0.5, 0.25, -3.0, 0.125, 0.25, 1.0], |n| {
        Primitive::Triangle { a: triple(&n[..3]), b: triple(&n[3..6]), c: triple(&n[6..]) }
    }),
    (&[0.5, -1.0, 1.0, 0.5, 4.0, 1.0, 1.5, 0.5, 0.25, -3.0, 0.125, 0.25, 1.0], |n| {
        Primitive::Cylinder { bottom: triple(&n[..3]), top: triple(&n[3..6]), radius: n[6] }
    }),
];

fn triple(numbers: &[f32]) -> [f32; 3] {
    [numbers[0], numbers[1], numbers[2]]
}

/// Catches a hit on what is nowhere: infinities that cancel, a NaN that a comparison lets pass.
#[test]
fn numbers_that_are_not_finite_hit_nothing() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for (numbers, primitive_of) in KINDS {
        let answer = |numbers: &[f32]| {
            let (primitive, ray) = numbers.split_at(numbers.len() - 6);
            let primitive = primitive_of(primitive);
            let ray = Ray { origin: triple(&ray[..3]), direction: triple(&ray[3..]) };
            guarantees::check(&primitive, &ray).unwrap_or_else(|violation| panic!("{violation}"));
            oracle::answer(&primitive, &ray)
        };
        assert!(answer(numbers).expect.is_hit());
        // Two at a time, or one where both places are the same.
        for (first, second) in (0..numbers.len()).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            for (with_first, with_second) in odd.into_iter().flat_map(|x| odd.map(|y| (x, y))) {
                let mut spoilt = numbers.to_vec();
                (spoilt[second], spoilt[first]) = (with_second, with_first);
                assert!(!answer(&spoilt).expect.is_hit());
            }
        }
    }
}
