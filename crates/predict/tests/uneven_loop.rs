//! Holds README's simulated table to the example that computes it.

#[path = "../examples/uneven-loop.rs"]
#[expect(dead_code, reason = "the example's main")]
mod example;

#[test]
fn the_documents_table_is_the_examples() {
    assert_eq!(example::table(), include_str!("../../../docs/results/short-answer.md"));
}
