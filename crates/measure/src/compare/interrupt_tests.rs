//! Measurements that are interrupted.

use super::tests::{QUEUE, REFERENCE, entry, fake, protocol, right};
use super::*;

/// Returns the comparison of three rows that is interrupted in this call: one call is for the
/// reference's image, three are for the warm-up, then three for each round.
fn interrupted_in(call: usize) -> Result<Comparison, CompareError> {
    let mut calls = 0;
    // The interrupted call fails, because its process is interrupted too.
    let mut executor = fake(|_, _| {
        calls += 1;
        if calls == call { Err("killed".to_owned()) } else { right(1) }
    });
    executor.interrupted_in = call;
    let result =
        protocol(8, 10, u64::MAX).run(REFERENCE, &[entry(QUEUE, 4)], &mut executor, |_| {});
    assert_eq!(executor.calls.len(), call, "it went on");
    result
}

/// Catches complete rounds that are lost, samples of the incomplete round that are kept, and an
/// interrupted rendering reported as a failure, at each place in a round.
#[test]
fn an_interrupted_comparison_has_the_complete_rounds() {
    for slot in 0..3 {
        let comparison = interrupted_in(1 + 3 + 7 * 3 + slot + 1).expect("enough rounds");
        assert_eq!((comparison.rounds, comparison.interrupted), (7, true), "slot {slot}");
        for row in &comparison.rows {
            assert!(row.passed() && row.speedup.is_some(), "slot {slot}: {row:?}");
            assert_eq!(row.samples_ns.len(), 7, "slot {slot}: {}", row.strategy);
        }
    }
    let all = protocol(8, 10, u64::MAX).run(REFERENCE, &[], &mut fake(|_, _| right(1)), |_| {});
    assert!(!all.expect("a reference image").interrupted);
}

/// Catches a table of fewer rounds than an interval needs.
#[test]
fn too_few_rounds_give_no_table() {
    for (call, rounds) in [(1, 0), (3, 0), (4, 0), (5, 0), (8, 1), (1 + 3 + 6 * 3, 5)] {
        let error = interrupted_in(call).expect_err("too early").to_string();
        let expected =
            format!("interrupted after {rounds} complete rounds; a table needs at least 6");
        assert!(error.starts_with(&expected), "call {call}: {error}");
    }
    assert_eq!(interrupted_in(1 + 3 + 6 * 3 + 1).expect("enough rounds").rounds, 6);
}

/// Catches a rendering that begins after the interruption.
#[test]
fn nothing_is_rendered_after_an_interruption() {
    let mut executor = fake(|_, _| right(1));
    executor.interrupted_in = 0;
    let result = protocol(8, 10, u64::MAX).run(REFERENCE, &[], &mut executor, |_| {});
    assert!(matches!(result, Err(CompareError::Interrupted(0))), "{result:?}");
    assert_eq!(executor.calls.len(), 0);
}
