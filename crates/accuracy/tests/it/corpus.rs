//! The committed corpus: the generators draw its cases digit for digit, and the oracle confirms its
//! answers.

use crate::written;
use rayweave_accuracy::{FAMILIES, HardCase, Primitive, answer, generate, json_lines};

/// `cargo run -p rayweave-accuracy --example hard-cases -- --seed 1977 --count 20 >
/// corpus/hard-cases.jsonl`
const CORPUS: &str = include_str!("../../corpus/hard-cases.jsonl");
const SEED: u64 = 1977;
const COUNT: usize = 20;

fn corpus() -> Vec<HardCase> {
    json_lines::read(CORPUS.as_bytes()).expect("the corpus is well formed")
}

#[test]
fn the_corpus_is_drawn_anew_digit_for_digit() {
    let cases: Vec<_> = FAMILIES.iter().flat_map(|family| generate(family, SEED, COUNT)).collect();
    let drawn = written(&cases);
    assert_eq!(drawn.lines().count(), CORPUS.lines().count());
    for (drawn, committed) in drawn.lines().zip(CORPUS.lines()) {
        assert_eq!(drawn, committed);
    }
}

#[test]
fn the_corpus_agrees_with_the_oracle() {
    let cases = corpus();
    assert_eq!(cases.len(), FAMILIES.len() * COUNT);
    for case in &cases {
        let answer = answer(&case.primitive, &case.ray);
        assert_eq!(Some(&answer.expect), case.expect.as_ref(), "{}", case.id);
        let hardness = (answer.cond, answer.margin, answer.decidable);
        assert_eq!(hardness, (case.cond, case.margin, case.decidable), "{}", case.id);
    }
}

#[test]
fn writing_what_was_read_gives_the_same_text() {
    let cases = corpus();
    assert!(written(&cases) == CORPUS);
    let is_mesh = |case: &&HardCase| matches!(case.primitive, Primitive::Mesh { .. });
    assert_eq!(cases.iter().filter(is_mesh).count(), 3 * COUNT);
}
