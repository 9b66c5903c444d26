//! The committed cases are what the generators draw, digit for digit, and what the oracle answers.

use rayweave_accuracy::{FAMILIES, HardCase, Primitive, answer, generate, json_lines};

/// `cargo run -p rayweave-accuracy --example hard-cases -- --seed 1977 --count 20 >
/// corpus/hard-cases.jsonl`
const CORPUS: &str = include_str!("../../corpus/hard-cases.jsonl");
const SEED: u64 = 1977;
const COUNT: usize = 20;

#[test]
fn the_corpus_is_drawn_anew_digit_for_digit() {
    let mut drawn = Vec::new();
    for family in &FAMILIES {
        json_lines::write(&mut drawn, &generate(family, SEED, COUNT))
            .expect("a vector takes everything");
    }
    let drawn = String::from_utf8(drawn).expect("JSON is text");
    assert_eq!(drawn.lines().count(), CORPUS.lines().count());
    for (drawn, committed) in drawn.lines().zip(CORPUS.lines()) {
        assert_eq!(drawn, committed);
    }
}

#[test]
fn the_corpus_is_read_and_answered_as_it_says() {
    let cases: Vec<HardCase> =
        json_lines::read(CORPUS.as_bytes()).expect("the corpus is well formed");
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
    let cases: Vec<HardCase> =
        json_lines::read(CORPUS.as_bytes()).expect("the corpus is well formed");
    let mut written = Vec::new();
    json_lines::write(&mut written, &cases).expect("a vector takes everything");
    assert!(written == CORPUS.as_bytes());
    let numbers =
        cases.iter().filter(|case| matches!(case.primitive, Primitive::Mesh { .. })).count();
    assert_eq!(numbers, 3 * COUNT);
}
