//! Surfaces that pass through a light do not hide it, and those just before it do, in each
//! precision, execution and orientation.

use rayweave_accuracy::shadows::{ShadowCase, shadow_cases};
use rayweave_contract::{Image, Rgb};
use rayweave_core::precision::PrecisionEstimate;
use rayweave_core::{Acceleration, Execution, Lanes, Precision, tracer};
use std::num::NonZeroU32;

/// The number of cases drawn, about a third more than must be decidable.
const DRAWN: usize = 2600;
const DECIDABLE: usize = 1500;

/// Renders the one pixel of a case, in every execution.
fn pixels(case: &ShadowCase, precision: Precision) -> Vec<Rgb> {
    let scene = case.scene.with_arithmetic(precision);
    let accelerations = [Acceleration::None, Acceleration::Auto];
    let executions = accelerations.into_iter().flat_map(|acceleration| {
        Lanes::ALL.map(|lanes| Execution { lanes, acceleration, ..Execution::default() })
    });
    let pixel = |execution| {
        let work = tracer(&scene, 1, 1, execution).expect("a sound scene");
        let mut image = Image::filled(1, 1, [f32::NAN; 3]).expect("an image");
        image.tiles(NonZeroU32::MIN).iter_mut().for_each(|tile| work.render(tile));
        image.pixels()[0]
    };
    executions.map(pixel).collect()
}

/// Checks the decidable cases, each in the precision that `precision` gives.
fn assert_right(cases: &[ShadowCase], precision: impl Fn(&ShadowCase) -> Option<Precision>) {
    let (mut decidable, mut wrong, mut lit) = (0, vec![], 0);
    for case in cases {
        let Some(precision) = precision(case) else { continue };
        if !case.is_decidable(precision) {
            continue;
        }
        decidable += 1;
        lit += usize::from(case.lit);
        let right =
            |[red, green, blue]: &Rgb| *red == 0.0 && (*green > 0.0) == case.lit && *blue == 0.0;
        let found = pixels(case, precision);
        if !found.iter().all(right) {
            wrong.push(format!("{precision}: {found:?}: {case}"));
        }
    }
    assert!(decidable >= DECIDABLE, "only {decidable} are decidable");
    assert!(lit * 4 > decidable && lit * 4 < decidable * 3, "{lit} of {decidable} are lit");
    let count = wrong.len();
    assert_eq!(count, 0, "of {decidable} are wrong; the first: {:?}", wrong.first());
}

/// Catches an end of shadow rays that does not know the angle, the scale or the scene's precision.
#[test]
fn lights_in_surfaces_and_close_to_them_are_seen_or_hidden() {
    let cases = shadow_cases(2026, DRAWN);
    let chosen = |case: &ShadowCase| PrecisionEstimate::of(&case.scene).precision();
    assert_right(&cases, |_| Some(Precision::F64));
    assert_right(&cases, |case| Some(chosen(case)));
    // Where `f32` is chosen, or could be.
    assert_right(&cases, |_| Some(Precision::F32));
}
