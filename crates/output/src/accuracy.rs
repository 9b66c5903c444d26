//! The score of a kernel on hard cases, as a table.

use crate::style;
use rayweave_accuracy::FamilyScore;

const HEADER: [&str; 9] = [
    "family",
    "cases",
    "wrong",
    "(borderline)",
    "leaks",
    "p99\nulp",
    "max\nulp",
    "max\n/ cond",
    "ns\na ray",
];

/// Returns a table with one row for each family of cases.
///
/// Errors are in `f32` ulps of the true `t`. `max / cond` is the largest error over its condition
/// number, which a stable formula keeps small. `times` holds the nanoseconds a ray of each family.
#[must_use]
pub fn table(scores: &[FamilyScore], times: &[Option<f64>]) -> String {
    let error = |value: Option<f64>| match value {
        Some(value) if value < 1e4 => format!("{value:.3}"),
        Some(value) => format!("{value:.1e}"),
        None => "-".to_owned(),
    };
    let rows = scores.iter().zip(times).map(|(score, time)| {
        [
            score.family.clone(),
            score.cases.to_string(),
            score.wrong.to_string(),
            format!("({})", score.wrong_borderline),
            score.leaks.to_string(),
            error(score.p99),
            error(score.max),
            error(score.max_by_condition),
            time.map_or_else(|| "-".to_owned(), |time| format!("{time:.0}")),
        ]
    });
    let table = style::table(HEADER, rows, 1..=8);
    let sum = |of: fn(&FamilyScore) -> usize| scores.iter().map(of).sum::<usize>();
    format!(
        "{table}\n{} cases, {} decidable: {} wrong, {} far off, {} leaks, {} not finite\n",
        sum(|s| s.cases),
        sum(|s| s.decidable),
        sum(|s| s.wrong),
        sum(|s| s.far),
        sum(|s| s.leaks),
        sum(|s| s.non_finite)
    )
}
