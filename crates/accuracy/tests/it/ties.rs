//! The first listed of surfaces in one plane is seen, however they are written.

use rayweave_accuracy::ties::{TieCase, tie_cases};
use rayweave_core::precision::PrecisionEstimate;
use rayweave_core::{Caster, Precision};

const DRAWN: usize = 2400;
const DECIDABLE: usize = 1500;

/// Checks the decidable cases, each in the precision that `precision` gives.
fn assert_right(cases: &[TieCase], precision: impl Fn(&TieCase) -> Precision) {
    let (mut decidable, mut wrong, mut later) = (0, vec![], 0);
    for case in cases {
        let precision = precision(case);
        if !case.is_decidable(precision) {
            continue;
        }
        decidable += 1;
        later += usize::from(case.first.is_some_and(|first| first > 0));
        let caster = Caster::new(&case.scene.with_arithmetic(precision)).expect("a sound scene");
        let [origin, direction] = case.ray;
        let found = caster.closest_hit(origin, direction).map(|hit| hit.primitive);
        if found != case.first {
            wrong.push(format!("{precision}: {found:?}, but {case}"));
        }
    }
    assert!(decidable >= DECIDABLE, "only {decidable} are decidable");
    assert!(later * 20 > decidable, "only {later} do not hit the first");
    let count = wrong.len();
    assert_eq!(count, 0, "of {decidable} are wrong; the first: {:?}", wrong.first());
}

/// Catches surfaces in one plane whose `t` differ by rounding.
#[test]
fn the_first_of_equal_surfaces_is_seen() {
    let cases = tie_cases(2026, DRAWN);
    let chosen = |case: &TieCase| PrecisionEstimate::of(&case.scene).precision();
    assert_right(&cases, |_| Precision::F64);
    assert_right(&cases, |_| Precision::F32);
    assert_right(&cases, chosen);
}
