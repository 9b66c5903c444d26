//! How right a kernel's answers to hard cases are, for people.

use rayweave_accuracy::FamilyScore;
use std::fmt::Write as _;

/// A row a family: errors in `f32` ulps of the true `t`; `max/cond` is the largest error over its
/// condition number, which a stable formula keeps small.
#[must_use]
pub fn table(scores: &[FamilyScore]) -> String {
    let mut text = format!(
        "{:22} {:>6} {:>6} {:>11} {:>6} {:>9} {:>9} {:>9}\n",
        "family", "cases", "wrong", "(borderline)", "leaks", "p99 ulp", "max ulp", "max/cond"
    );
    let figure = |value: Option<f64>| match value {
        Some(value) if value < 1e4 => format!("{value:.3}"),
        Some(value) => format!("{value:.1e}"),
        None => "-".to_owned(),
    };
    for score in scores {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:22} {:>6} {:>6} {:>12} {:>6} {:>9} {:>9} {:>9}",
            score.family,
            score.cases,
            score.wrong,
            format!("({})", score.wrong_borderline),
            score.leaks,
            figure(score.p99),
            figure(score.max),
            figure(score.max_by_condition)
        );
    }
    let sum = |of: fn(&FamilyScore) -> usize| scores.iter().map(of).sum::<usize>();
    let _ = writeln!(
        text,
        "{} cases, {} decidable: {} wrong, {} leaks, {} not finite",
        sum(|s| s.cases),
        sum(|s| s.decidable),
        sum(|s| s.wrong),
        sum(|s| s.leaks),
        sum(|s| s.non_finite)
    );
    text
}
