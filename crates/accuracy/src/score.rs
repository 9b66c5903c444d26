//! The score of a kernel: compares its outcomes with the exact answers, family by family.

use std::collections::HashMap;

use dashu_ratio::RBig;

use crate::cases::{Expect, HardCase};
use crate::outcomes::Outcome;

/// The number of bits of an f32 after the first.
const FRACTION_BITS: isize = 23;
/// The error by condition, in ulps, above which a `t` is far off. Kernels that are right stay below
/// 1, those with textbook formulas mostly below 100.
const FAR: f64 = 1000.0;
/// The exponent of the smallest normal f32.
const SMALLEST_EXPONENT: isize = -126;

/// The score of a kernel on the cases of one family.
///
/// An outcome is wrong if it is absent, if hit or miss is wrong, or if a hit has no finite `t`
/// above 0. Errors are those of `t`, in f32 ulps of the true `t`, on decidable hits that the kernel
/// found too; `None` where there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FamilyScore {
    /// The name of the family.
    pub family: String,
    /// The number of cases with an answer.
    pub cases: usize,
    /// The number of decidable cases; the others are borderline.
    pub decidable: usize,
    /// The number of wrong outcomes on decidable cases.
    pub wrong: usize,
    /// The number of wrong outcomes on borderline cases.
    pub wrong_borderline: usize,
    /// The number of measured errors.
    pub measured: usize,
    /// The number of errors above a thousandth of `t`: the wrong root, or noise.
    pub gross: usize,
    /// The number of errors above 1,000 ulps times the condition number: no rounding explains them.
    pub far: usize,
    /// The number of hits with a `t` that is absent or not finite.
    pub non_finite: usize,
    /// The number of meshes that must be hit.
    pub meshes: usize,
    /// The number of meshes that were not hit: the ray leaked between two triangles.
    pub leaks: usize,
    /// The median error.
    pub p50: Option<f64>,
    /// The error that 99 of 100 cases do not exceed.
    pub p99: Option<f64>,
    /// The largest error.
    pub max: Option<f64>,
    /// The largest error divided by the condition number, where that is above 1. A backward stable
    /// kernel keeps it below a small number in every family.
    pub max_by_condition: Option<f64>,
}

impl FamilyScore {
    /// Returns the number of borderline cases.
    #[must_use]
    pub fn borderline(&self) -> usize {
        self.cases - self.decidable
    }
}

/// Scores outcomes family by family, in the order of their first cases. Cases without an answer are
/// left out. If several outcomes have the same id, the last counts; outcomes with an unknown id do
/// not count.
#[must_use]
pub fn score(cases: &[HardCase], outcomes: &[Outcome]) -> Vec<FamilyScore> {
    let outcomes: HashMap<&str, &Outcome> =
        outcomes.iter().map(|outcome| (outcome.id.as_str(), outcome)).collect();
    let mut tallies: Vec<Tally> = Vec::new();
    for case in cases {
        let Some(expect) = &case.expect else { continue };
        // Cases of a family are mostly adjacent, so the search ends at once.
        let known = tallies.iter().rposition(|tally| tally.score.family == case.family);
        let place = known.unwrap_or_else(|| {
            tallies.push(Tally::new(&case.family));
            tallies.len() - 1
        });
        tallies[place].add(case, expect, outcomes.get(case.id.as_str()).copied());
    }
    tallies.into_iter().map(Tally::finish).collect()
}

/// The score of a family while its cases are counted.
struct Tally {
    score: FamilyScore,
    errors: Vec<f64>,
}

impl Tally {
    fn new(family: &str) -> Self {
        Self {
            score: FamilyScore { family: family.to_owned(), ..FamilyScore::default() },
            errors: Vec::new(),
        }
    }

    fn add(&mut self, case: &HardCase, expect: &Expect, outcome: Option<&Outcome>) {
        let score = &mut self.score;
        let hit = outcome.is_some_and(|outcome| outcome.hit);
        let t = outcome.filter(|outcome| outcome.hit).and_then(|outcome| outcome.t);
        let finite_t = t.filter(|t| t.is_finite());
        let mesh = matches!(expect, Expect::MeshHit { .. });
        let right = match outcome {
            None => false,
            Some(_) if hit => expect.is_hit() && finite_t.is_some_and(|t| t > 0.0),
            Some(_) => !expect.is_hit(),
        };
        score.cases += 1;
        score.non_finite += usize::from(hit && finite_t.is_none());
        score.meshes += usize::from(mesh);
        score.leaks += usize::from(mesh && !right);
        if !(case.decidable || mesh) {
            score.wrong_borderline += usize::from(!right);
            return;
        }
        score.decidable += 1;
        score.wrong += usize::from(!right);
        if let (true, Some(t), Some(expected)) = (right, finite_t, expect.t()) {
            let error = Error::of(t, &expected.exact());
            score.gross += usize::from(error.gross);
            self.errors.push(error.ulps);
            let by_condition = error.ulps / case.cond.max(1.0);
            score.far += usize::from(by_condition > FAR);
            score.max_by_condition = Some(score.max_by_condition.unwrap_or(0.0).max(by_condition));
        }
    }

    fn finish(mut self) -> FamilyScore {
        self.errors.sort_by(f64::total_cmp);
        // The smallest error that at least this share of all errors does not exceed.
        let quantile = |share: f64| {
            let rank = (share * self.errors.len() as f64).ceil() as usize;
            self.errors.get(rank.max(1) - 1).copied()
        };
        FamilyScore {
            measured: self.errors.len(),
            p50: quantile(0.5),
            p99: quantile(0.99),
            max: self.errors.last().copied(),
            ..self.score
        }
    }
}

/// The error of a `t`.
struct Error {
    ulps: f64,
    gross: bool,
}

impl Error {
    /// Computes the error; only the result is rounded.
    fn of(t: f64, expected: &RBig) -> Self {
        let size = |value: RBig| if value < RBig::ZERO { -value } else { value };
        let error = size(RBig::try_from(t).unwrap_or_default() - expected);
        let expected = size(expected.clone());
        Self {
            ulps: (&error / ulp(&expected)).to_f64().value(),
            gross: error * RBig::from(1000) > expected,
        }
    }
}

/// Returns the spacing of f32 numbers at this size, as if there were no largest f32.
fn ulp(size: &RBig) -> RBig {
    let power = |exponent: isize| RBig::from(2).pow(exponent);
    // The f64 logarithm may be off by one beside a power of two.
    let mut exponent =
        size.to_f64().value().log2().floor().clamp(SMALLEST_EXPONENT as f64, 1023.0) as isize;
    while exponent > SMALLEST_EXPONENT && power(exponent) > *size {
        exponent -= 1;
    }
    while power(exponent + 1) <= *size {
        exponent += 1;
    }
    power(exponent - FRACTION_BITS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::{Primitive, Ray};

    fn rational(text: &str) -> RBig {
        text.parse::<crate::Decimal>().expect("a number").exact()
    }

    #[test]
    fn ulps_change_at_powers_of_two() {
        let below_one = "0.9999999999999999999999999999999999999999";
        assert_eq!(Error::of(1.0 + 2.0_f64.powi(-24), &rational("1")).ulps, 0.5);
        assert!(
            (Error::of(1.0 + 2.0_f64.powi(-24), &rational(below_one)).ulps - 1.0).abs() < 1e-15
        );
        assert_eq!(Error::of(2.0, &rational("1.5")).ulps, f64::from(1 << 22));
        // Subnormal numbers all have the spacing of the smallest normal ones.
        assert_eq!(ulp(&rational("1e-44")), RBig::from(2).pow(-149));
        assert_eq!(ulp(&RBig::ZERO), RBig::from(2).pow(-149));
        assert_eq!(ulp(&rational("1e900")), RBig::from(2).pow(2989 - 23));
    }

    #[test]
    fn gross_is_more_than_a_thousandth() {
        assert!(!Error::of(1001.0, &rational("1000")).gross);
        assert!(Error::of(1001.5, &rational("1000")).gross);
        assert!(Error::of(998.5, &rational("1000")).gross);
    }

    /// Returns a case of family `f` with the answer `t`, or a miss. It is a mesh if its id begins
    /// with `m`.
    fn case(id: &str, t: Option<&str>, decidable: bool) -> HardCase {
        let decimal = |text: &str| text.parse::<crate::Decimal>().expect("a number");
        let vector = || Box::new(["0", "0", "0"].map(decimal));
        let expect = match t.map(decimal) {
            None => Expect::Miss,
            Some(t) if id.starts_with('m') => Expect::MeshHit { t },
            Some(t) => Expect::Hit { t, point: vector(), normal: vector() },
        };
        HardCase {
            family: "f".into(),
            id: id.into(),
            primitive: Primitive::Mesh { triangles: Vec::new() },
            ray: Ray { origin: [0.0; 3], direction: [1.0; 3] },
            expect: Some(expect),
            decidable,
            cond: 4.0,
            margin: 0.0,
            note: String::new(),
        }
    }

    fn outcome(id: &str, t: Option<f64>) -> Outcome {
        Outcome { id: id.into(), hit: t.is_some(), t }
    }

    #[test]
    fn every_kind_of_wrong_outcome_is_counted_once() {
        let ulp = 2.0_f64.powi(-23);
        let cases = [
            case("right", Some("1"), true),
            case("off", Some("1"), true),
            case("unseen", Some("1"), true),
            case("invented", None, true),
            case("nan", Some("1"), true),
            case("backward", Some("1"), true),
            case("absent", None, true),
            case("blurred", None, false),
            case("mesh", Some("1"), false),
            case("m-leak", Some("1"), false),
        ];
        let outcomes = [
            outcome("right", Some(1.0)),
            outcome("off", Some(1.0 + 8.0 * ulp)),
            outcome("unseen", None),
            outcome("invented", Some(1.0)),
            outcome("nan", Some(f64::NAN)),
            outcome("backward", Some(-1.0)),
            outcome("blurred", Some(1.0)),
            outcome("mesh", Some(2.0)),
            outcome("m-leak", None),
            outcome("unknown", Some(1.0)),
        ];
        let found = score(&cases, &outcomes);
        let expected = FamilyScore {
            family: "f".into(),
            cases: 10,
            decidable: 9,
            wrong: 6,
            wrong_borderline: 1,
            measured: 3,
            gross: 1,
            far: 1,
            non_finite: 1,
            meshes: 2,
            leaks: 1,
            p50: Some(8.0),
            p99: Some(1.0 / ulp),
            max: Some(1.0 / ulp),
            max_by_condition: Some(0.25 / ulp),
        };
        assert_eq!(found, [expected]);
        assert_eq!(found[0].borderline(), 1);
    }

    #[test]
    fn cases_without_an_answer_and_empty_families_have_no_errors() {
        let unanswered = HardCase { expect: None, ..case("a", None, true) };
        assert_eq!(score(&[unanswered], &[]), []);
        let [only] = &score(&[case("b", None, true)], &[outcome("b", None)])[..] else { panic!() };
        assert_eq!((only.max, only.p50, only.wrong), (None, None, 0));
    }
}
