//! The robust kernel keeps the guarantees of `rayweave_accuracy::guarantees`, in f64 and f32, on
//! random and on structured input.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_accuracy::{Primitive, Ray, guarantees, oracle};

/// Generates multiples of 1/16. They have so few bits that products of several do not round, so
/// rays meet corners, edges, tangents and parallels exactly.
fn fraction() -> impl Strategy<Value = f32> {
    (-64..=64i8).prop_map(|k| f32::from(k) / 16.0)
}

/// Generates a position between two ends, as a share of the way: anywhere, at an end, or just
/// beside one.
fn share() -> impl Strategy<Value = f32> {
    let beside = (any::<bool>(), any::<bool>(), 4..24i32).prop_map(|(at_end, beyond, exponent)| {
        f32::from(u8::from(at_end))
            + if beyond { 2f32.powi(-exponent) } else { -2f32.powi(-exponent) }
    });
    prop_oneof![fraction().prop_map(|k| k / 4.0), beside]
}

/// Generates numbers of a size of 2^-12 to 2^12, with either sign.
fn sized() -> impl Strategy<Value = f32> {
    (-12..12i32, 1.0..2.0f32, any::<bool>())
        .prop_map(|(exponent, size, up)| 2f32.powi(exponent) * if up { size } else { -size })
}

/// Generates numbers of any finite size, rarely subnormal or huge ones.
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

/// A ray, and the place of the ray and the primitive.
#[derive(Clone, Debug)]
struct Setting {
    origin: [f32; 3],
    /// The direction, if the ray does not go to its target.
    direction: Option<[f32; 3]>,
    /// An offset of all positions. Its rounding lets the ray pass its target at a small distance.
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

/// A function that moves a position.
type Put<'a> = &'a dyn Fn([f32; 3]) -> [f32; 3];

/// Checks the primitive that the closure builds, with a function that moves its positions.
fn check(
    primitive: impl FnOnce(Put<'_>) -> Primitive,
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

    /// Catches a plane with one side, a hit behind the ray, and heights that are not differences.
    #[test]
    fn planes_are_hit_where_they_are(
        point in vector(),
        normal in vector(),
        aside in [fraction(), fraction()],
        setting in setting(),
    ) {
        // Two vectors perpendicular to the normal.
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

    /// Catches a back that is not hit, an edge with the wrong sign, and corners or distances not
    /// computed as differences.
    #[test]
    fn triangles_are_hit_where_they_are(
        corners in [vector(), vector(), vector()],
        shares in [share(), share()],
        setting in setting(),
    ) {
        let [a, b, c] = corners;
        // A point of the plane: at a corner, on or just beside an edge, inside or outside.
        let aim = moved(moved(a, difference(b, a), shares[0]), difference(c, a), shares[1]);
        check(|put| Primitive::Triangle { a: put(a), b: put(b), c: put(c) }, &setting, aim)?;
    }

    /// Catches a far wall that is not hit through the open end, heights that are not differences,
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
        let wall = |put: Put<'_>| {
            Primitive::Cylinder { bottom: put(bottom), top: put(top), radius }
        };
        check(wall, &setting, aim)?;
    }
}

/// The numbers of a primitive and then of a ray, and the constructor of the primitive.
type Kind = (&'static [f32], fn(&[f32]) -> Primitive);

/// One primitive of each kind, with a ray that hits it.
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

/// Catches infinities that cancel, and a NaN that passes a comparison.
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
