//! The tracer's kernel keeps its thresholds on the committed hard cases.

use rayweave_accuracy::{HardCase, Tier, json_lines, kernel, score};
use rayweave_core::{Arithmetic, Formulas, Precision};

/// Returns the families in which the kernel exceeds a threshold.
fn misses(formulas: Formulas, precision: Precision, tier: Tier) -> Vec<String> {
    let corpus = include_str!("../../corpus/hard-cases.jsonl");
    let cases: Vec<HardCase> = json_lines::read(corpus.as_bytes()).expect("the corpus");
    let arithmetic = Arithmetic { formulas, precision };
    let outcomes: Vec<_> = cases.iter().map(|case| kernel::outcome(case, arithmetic)).collect();
    let scores = score(&cases, &outcomes);
    scores
        .into_iter()
        .filter(|score| !tier.exceeded(score).is_empty())
        .map(|score| score.family)
        .collect()
}

/// Catches any formula of the kernel that loses a verdict or its stability.
#[test]
fn the_robust_formulas_keep_their_thresholds() {
    assert_eq!(misses(Formulas::Robust, Precision::F32, Tier::Plain32), [""; 0]);
    assert_eq!(misses(Formulas::Robust, Precision::F64, Tier::Double), [""; 0]);
}

/// Catches a corpus or a score that every kernel passes.
#[test]
fn the_textbook_formulas_do_not() {
    let misses = misses(Formulas::Textbook, Precision::F32, Tier::Plain32);
    assert!(misses.len() > 10, "{misses:?}");
}
