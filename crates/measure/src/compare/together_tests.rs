//! Tests of several executors that are measured in the same rounds.

use super::tests::{POOL, REFERENCE, entry, protocol, right, wrong};
use super::*;
use crate::statistics::{Interval, ratio_interval};
use std::cell::RefCell;

/// One of several executors. All record their calls in one list, which is also their clock.
struct Part<'a, F> {
    number: usize,
    calls: &'a RefCell<Vec<(usize, &'static str)>>,
    answer: F,
}

impl<F: FnMut(&'static str, usize) -> Result<Sample, String>> Executor for Part<'_, F> {
    fn render(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        let call = (self.number, entry.strategy.name);
        let before = self.calls.borrow().iter().filter(|&&earlier| earlier == call).count();
        self.calls.borrow_mut().push(call);
        (self.answer)(call.1, before)
    }

    fn elapsed(&self) -> Duration {
        Duration::from_nanos(self.calls.borrow().len() as u64)
    }
}

type Calls = Vec<(usize, &'static str)>;

/// Measures two executors together, with the pool beside the reference.
fn together(
    rounds: usize,
    first: impl FnMut(&'static str, usize) -> Result<Sample, String>,
    second: impl FnMut(&'static str, usize) -> Result<Sample, String>,
) -> ([Comparison; 2], Calls) {
    let calls = RefCell::default();
    let mut first = Part { number: 0, calls: &calls, answer: first };
    let mut second = Part { number: 1, calls: &calls, answer: second };
    let comparisons = protocol(rounds, rounds, u64::MAX)
        .run_together(REFERENCE, &[entry(POOL, 2)], &mut [&mut first, &mut second], |_| {})
        .expect("a reference image");
    (comparisons.try_into().expect("two comparisons"), calls.into_inner())
}

#[test]
fn together_each_round_has_the_rows_of_all() {
    let (comparisons, calls) = together(8, |_, _| right(1), |_, _| right(1));
    let (before, measured) = calls.split_at(1 + 6);
    assert_eq!(before[0], (0, "reference"));
    for round in measured.chunks(6) {
        let mut round = round.to_vec();
        round.sort_unstable();
        let rows = ["pool", "reference", "reference"];
        let expected: Calls =
            [0, 1].into_iter().flat_map(|number| rows.map(|name| (number, name))).collect();
        assert_eq!(round, expected);
    }
    let apart = |round: &[(usize, &str)]| round.is_sorted_by_key(|(number, _)| *number);
    assert!(!measured.chunks(6).all(apart), "one after the other: {measured:?}");
    for comparison in comparisons {
        assert_eq!((comparison.rounds, comparison.rows.len(), comparison.passed()), (8, 3, true));
        assert!(comparison.rows.iter().all(|row| row.samples_ns.len() == 8));
    }
}

#[test]
fn times_of_one_over_times_of_another_are_ratios_within_a_round() {
    // Rounds slow down by a factor that all share. The first's reference is called once more, for
    // the image.
    let slow = |name, call: usize, first| match name {
        "reference" => 1000 << (call.saturating_sub(first) / 2),
        _ => 1,
    };
    let ([a, b], _) = together(
        5,
        |name, call| right(slow(name, call, 3)),
        |name, call| right(3 * slow(name, call, 2)),
    );
    let [a, b] = [a, b].map(|mut comparison| comparison.rows.swap_remove(0).samples_ns);
    assert_eq!(ratio_interval(&b, &a), Some(Interval::exactly(3.0)));
}

#[test]
fn all_have_to_give_the_image_of_the_first() {
    let ([a, b], _) = together(3, |_, _| right(1), |_, _| wrong(1));
    assert!(a.passed() && a.rows[2].speedup.is_some());
    assert!(b.rows.iter().all(|row| !row.identical && row.speedup.is_none()));
}

#[test]
fn a_reference_that_fails_ends_its_own_comparison() {
    let fails = |name, call| {
        if name == "reference" && call >= 6 { Err("gone".to_owned()) } else { right(1) }
    };
    let ([a, b], _) = together(6, |_, _| right(1), fails);
    assert!(
        a.passed() && a.rows.iter().all(|row| row.samples_ns.len() == 6 && row.speedup.is_some())
    );
    // The warm-up and two rounds, each with the reference and its control, then the third.
    assert!(
        b.rows.iter().all(|row| (2..=3).contains(&row.samples_ns.len()) && row.speedup.is_none())
    );

    let ([a, b], calls) = together(6, fails, fails);
    assert!(!a.passed() && !b.passed());
    assert!(calls.len() <= 1 + 6 + 3 * 6, "measured on without any reference: {}", calls.len());
}
