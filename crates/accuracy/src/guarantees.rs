//! The guarantees of the robust kernel for any ray and any primitive, checked against the oracle.
//!
//! * The kernel never panics.
//! * Meaningless input is a miss: a number that is not finite, a direction of zero, or a primitive
//!   that no scene may contain. Such primitives include cylinders without height, and triangles
//!   whose area a scene takes for 0, to 8 roundings of f64, even where the oracle tells it from 0.
//! * In f64, for all other f32 input: a hit has a finite `t` above 0; a decidable verdict is right;
//!   and the relative error of `t` on a decidable hit is at most [`ERROR`] epsilons per unit of its
//!   condition number. That is far within the thresholds of [`Tier::Double`].
//! * In f32 the same holds, with the epsilon of f32, where the products of a few of the numbers
//!   stay within its range:
//!
//!   - the radius, and each coordinate of each difference of two positions, is 0 or has a magnitude
//!     in [`LENGTHS`];
//!   - the longest component of the direction has a magnitude in [`DIRECTIONS`]; its other
//!     components, and those of a normal, are 0 or at least [`FLATTEST`] of the longest.
//!
//! A verdict is decidable where the oracle says so, with two exceptions:
//!
//! * The kernel may miss a hit whose `t` may be off by all of itself, by the bound above: such a
//!   `t` cannot be told from 0. An example is a ray that starts on a sphere, to the last bit, and
//!   cuts off less than 2^-12 of it.
//! * A triangle needs a larger margin where a vertex, as seen from the ray's origin, is far along
//!   one axis and near along another: [`SPREAD`] ulps, of the precision, per unit of the ratio of
//!   its coordinates other than 0. The watertight test shears the coordinates into one, which is
//!   rounded as the large one is. At an edge a thousand times as long as its distance, the kernel
//!   tells a ray through the edge from one beside it to some 100 ulps only. Both triangles at the
//!   edge agree on the side, so nothing leaks.
//!
//! [`Tier::Plain32`] asks for 2 ulps per unit of the condition number, in the families. Two
//! epsilons are 2 ulps just above a power of two and 4 just below. Other cases do reach more than
//! 2 ulps, about one in a million. For a plane, two epsilons are the sum of all roundings.
//!
//! [`Tier::Double`]: crate::Tier::Double
//! [`Tier::Plain32`]: crate::Tier::Plain32

use std::fmt;
use std::ops::RangeInclusive;

use dashu_ratio::RBig;
use glam::DVec3;
use rayweave_core::Precision;
use rayweave_core::scene::Triangle;

use crate::cases::{Expect, HardCase, Primitive, Ray, double};
use crate::decimal::Decimal;
use crate::kernel;
use crate::oracle::{self, DECIDABLE_MARGIN, ExactAnswer, INFINITE};
use crate::outcomes::Outcome;

/// The largest relative error of `t`, in epsilons per unit of its condition number.
pub const ERROR: f64 = 2.0;
/// The margin of a triangle's verdict, in ulps per unit of a vertex's ratio of coordinates. It is
/// three times the worst case that a search found.
pub const SPREAD: f64 = 0.5;
/// The lengths that f32 must handle, 2^-20 to 2^27.
pub const LENGTHS: RangeInclusive<f64> = 1.0 / (1_u32 << 20) as f64..=(1_u32 << 27) as f64;
/// The longest components of directions that f32 must handle, 2^-30 to 2^30.
pub const DIRECTIONS: RangeInclusive<f64> = 1.0 / (1_u32 << 30) as f64..=(1_u32 << 30) as f64;
/// The smallest component of a direction that f32 must handle, relative to the longest.
pub const FLATTEST: f64 = 1.0 / (1_u32 << 20) as f64;

/// A case in which the kernel violated a guarantee.
#[derive(Clone, Debug)]
pub struct Violation {
    /// The inputs and the exact answer.
    pub case: HardCase,
    /// The precision in which the kernel computed.
    pub precision: Precision,
    /// The answer of the kernel.
    pub outcome: Outcome,
    /// The guarantee that it violates.
    pub problem: &'static str,
}

/// Shows the problem, then the case on a line of its own, as `rayweave intersect` reads it.
impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { case, precision, outcome, problem } = self;
        let case = serde_json::to_string(case).map_err(|_| fmt::Error)?;
        write!(f, "{precision}: {problem}: hit {}, t {:?}\n{case}", outcome.hit, outcome.t)
    }
}

/// Sends `ray` against `primitive` through the kernel, in f64 and in f32. There are no guarantees
/// for meshes.
///
/// # Errors
///
/// The first violation.
pub fn check(primitive: &Primitive, ray: &Ray) -> Result<(), Box<Violation>> {
    let Some(inputs) = Inputs::of(primitive, ray) else { return Ok(()) };
    let meaningful = inputs.are_meaningful(primitive);
    let answer = if meaningful {
        oracle::answer(primitive, ray)
    } else {
        ExactAnswer {
            expect: Expect::Miss,
            cond: 0.0,
            margin: INFINITE,
            decidable: true,
            reason: "no meaning",
        }
    };
    let case = HardCase {
        family: "any".into(),
        id: "any".into(),
        primitive: primitive.clone(),
        ray: *ray,
        expect: Some(answer.expect.clone()),
        decidable: answer.decidable,
        cond: answer.cond,
        margin: answer.margin,
        note: answer.reason.into(),
    };
    for (precision, epsilon) in
        [(Precision::F64, f64::EPSILON), (Precision::F32, f32::EPSILON.into())]
    {
        let outcome = kernel::outcome(&case, precision.into());
        if meaningful && precision == Precision::F32 && !inputs.fit_f32() {
            continue;
        }
        if let Some(problem) =
            problem(&answer, &outcome, inputs.sure_margin(epsilon), ERROR * epsilon)
        {
            return Err(Box::new(Violation { case, precision, outcome, problem }));
        }
    }
    Ok(())
}

/// Returns the guarantee that an outcome violates, or `None`.
fn problem(
    answer: &ExactAnswer,
    outcome: &Outcome,
    sure_margin: f64,
    error: f64,
) -> Option<&'static str> {
    let t = outcome.t.filter(|t| t.is_finite() && *t > 0.0);
    if outcome.hit && t.is_none() {
        return Some("a hit without a finite t above 0");
    }
    let error = error * answer.cond.max(1.0);
    if answer.margin < sure_margin || (answer.expect.is_hit() && error >= 1.0) {
        return None;
    }
    match (answer.expect.t(), t) {
        (None, None) => None,
        (None, Some(_)) => Some("a hit where there is none"),
        (Some(_), None) => Some("no hit where there is one"),
        (Some(expected), Some(t)) => (relative_error(t, expected) > error)
            .then_some("an error larger than its condition number says"),
    }
}

/// Returns the relative error of `t`; `expected` is not 0.
fn relative_error(t: f64, expected: &Decimal) -> f64 {
    let expected = expected.exact();
    ((RBig::try_from(t).unwrap_or_default() - &expected) / expected).to_f64().value().abs()
}

/// The numbers of a ray and a primitive, by meaning.
struct Inputs {
    origin: DVec3,
    direction: DVec3,
    /// The positions of the primitive.
    positions: Vec<DVec3>,
    normal: Option<DVec3>,
    radius: Option<f64>,
}

impl Inputs {
    /// Collects the numbers; `None` for a mesh.
    fn of(primitive: &Primitive, ray: &Ray) -> Option<Self> {
        let (positions, normal, radius) = match *primitive {
            Primitive::Plane { point, normal } => (vec![point], Some(normal), None),
            Primitive::Sphere { center, radius } => (vec![center], None, Some(radius)),
            Primitive::Triangle { a, b, c } => (vec![a, b, c], None, None),
            Primitive::Cylinder { bottom, top, radius } => (vec![bottom, top], None, Some(radius)),
            Primitive::Mesh { .. } => return None,
        };
        Some(Self {
            origin: double(ray.origin),
            direction: double(ray.direction),
            positions: positions.into_iter().map(double).collect(),
            normal: normal.map(double),
            radius: radius.map(f64::from),
        })
    }

    /// Returns whether there is a ray and a scene may contain the primitive. Primitives that the
    /// oracle rejects as well need no check here.
    fn are_meaningful(&self, primitive: &Primitive) -> bool {
        let accepted = match (primitive, &self.positions[..]) {
            (Primitive::Triangle { .. }, &[a, b, c]) => {
                Triangle { vertices: [a, b, c], material: 0 }.check().is_ok()
            }
            (Primitive::Cylinder { .. }, [bottom, top]) => bottom.y < top.y,
            _ => true,
        };
        let vectors =
            self.positions.iter().chain(&self.normal).chain([&self.origin, &self.direction]);
        accepted
            && self.direction != DVec3::ZERO
            && vectors.into_iter().all(|vector| vector.is_finite())
            && self.radius.is_none_or(f64::is_finite)
    }

    /// Returns whether products of a few of the numbers stay within the range of f32.
    fn fit_f32(&self) -> bool {
        let fits = |length: f64| length == 0.0 || LENGTHS.contains(&length.abs());
        let even = |v: DVec3| {
            let least = FLATTEST * v.abs().max_element();
            v.to_array().into_iter().all(|component| component == 0.0 || component.abs() >= least)
        };
        let ends = || self.positions.iter().chain([&self.origin]);
        ends().all(|&a| ends().all(|&b| (a - b).to_array().into_iter().all(fits)))
            && self.radius.is_none_or(fits)
            && self.normal.is_none_or(even)
            && even(self.direction)
            && DIRECTIONS.contains(&self.direction.abs().max_element())
    }

    /// Returns the margin, in ulps of f32, from which the verdict is guaranteed.
    fn sure_margin(&self, epsilon: f64) -> f64 {
        // Three positions make a triangle.
        let [_, _, _] = self.positions[..] else { return DECIDABLE_MARGIN };
        let spread = |&vertex: &DVec3| {
            let coordinates = (vertex - self.origin).abs().to_array();
            let least = coordinates.into_iter().filter(|&x| x > 0.0).fold(f64::INFINITY, f64::min);
            coordinates.into_iter().fold(0.0, f64::max) / least
        };
        let widest = self.positions.iter().map(spread).fold(1.0, f64::max);
        DECIDABLE_MARGIN.max(SPREAD * widest * epsilon / f64::from(f32::EPSILON))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(t: Option<&str>) -> ExactAnswer {
        let decimal = |text: &str| text.parse::<Decimal>().expect("a number");
        let expect = t.map_or(Expect::Miss, |t| Expect::MeshHit { t: decimal(t) });
        ExactAnswer { expect, cond: 3.0, margin: 8.0, decidable: true, reason: "" }
    }

    fn outcome(t: Option<f64>) -> Outcome {
        Outcome { id: String::new(), hit: t.is_some(), t }
    }

    /// Catches a check that always passes.
    #[test]
    fn every_violation_is_found() {
        let judge = |expected, found, sure| {
            problem(&answer(expected), &outcome(found), sure, 2.0 * f64::EPSILON)
        };
        let wrong = [
            (Some("1"), None),
            (None, Some(1.0)),
            (Some("1"), Some(f64::NAN)),
            (Some("1"), Some(f64::INFINITY)),
            (Some("1"), Some(0.0)),
            (Some("1"), Some(-1.0)),
            (Some("1"), Some(1.0 + 7.0 * f64::EPSILON)),
        ];
        for (expected, found) in wrong {
            assert!(judge(expected, found, 8.0).is_some(), "{expected:?} {found:?}");
        }
        for (expected, found) in [(None, None), (Some("1"), Some(1.0 + 6.0 * f64::EPSILON))] {
            assert_eq!(judge(expected, found, 8.0), None);
        }
        // Below the margin either verdict will do, but not any `t`.
        for found in [None, Some(1.5)] {
            assert_eq!(judge(Some("1"), found, 9.0), None);
        }
        assert!(judge(None, Some(0.0), 9.0).is_some());
        // The same holds where no digit of `t` is certain.
        let blurred = ExactAnswer { cond: 0.25 / f64::EPSILON, ..answer(Some("1")) };
        assert!(problem(&blurred, &outcome(None), 8.0, f64::EPSILON).is_some());
        assert_eq!(problem(&blurred, &outcome(None), 8.0, 4.0 * f64::EPSILON), None);
    }

    /// Catches limits that exclude ordinary input, or that exclude nothing.
    #[test]
    fn the_limits_of_f32_are_as_documented() {
        let inputs = |center: [f32; 3], radius, direction| {
            let ray = Ray { origin: [1.0, 2.0, 3.0], direction };
            Inputs::of(&Primitive::Sphere { center, radius }, &ray).expect("no mesh")
        };
        let (center, down) = ([1.0, -2.0, 1e3], [0.0, -1e-3, 1.0]);
        assert!(inputs(center, 2.0, down).fit_f32());
        assert!(inputs([1.0 + 2e-6, 2.0, 1e8], 1e8, [1e-5, 1e-3, 2.0]).fit_f32());
        let outside = [
            inputs([1.0 + 2e-7, 2.0, 3.0], 2.0, down),
            inputs([1.0, 2.0, 2e8], 2.0, down),
            inputs(center, 1e-7, down),
            inputs(center, f32::INFINITY, down),
            inputs(center, 2.0, [1.0, 1e-7, 0.0]),
            inputs(center, 2.0, [0.0, 1e10, 0.0]),
            inputs(center, 2.0, [0.0, f32::NAN, 1.0]),
        ];
        assert!(outside.iter().all(|inputs| !inputs.fit_f32()));
    }

    /// Catches a spread not measured from the origin, or the same in both precisions.
    #[test]
    fn a_wide_triangle_needs_a_wide_margin() {
        let ray = Ray { origin: [1.0; 3], direction: [0.0, 0.0, 1.0] };
        let triangle =
            Primitive::Triangle { a: [0.0, 0.0, 3.0], b: [1.0, 2.0, 101.0], c: [1.0; 3] };
        let inputs = Inputs::of(&triangle, &ray).expect("no mesh");
        assert_eq!(inputs.sure_margin(f32::EPSILON.into()), 50.0);
        assert_eq!(inputs.sure_margin(f64::EPSILON), DECIDABLE_MARGIN);
    }
}
