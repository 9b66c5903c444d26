//! Tests of the protocol's logic with a fake executor and its clock.

use super::*;
use crate::fakes::named;
use crate::statistics::Interval;
use rayweave_contract::{Image, Threads};

pub(super) static REFERENCE: Strategy = named("reference", Threads::None);
pub(super) static POOL: Strategy = named("pool", Threads::Pool);
pub(super) static QUEUE: Strategy = named("queue", Threads::PerRender);

/// An executor that answers the n-th call of a strategy by a function of its name and n, and
/// advances its clock by the answer.
pub(super) struct Fake<F> {
    answer: F,
    pub(super) calls: Vec<&'static str>,
    clock: Duration,
    /// The call during which it is interrupted, counted from 1.
    pub(super) interrupted_in: usize,
}

impl<F: FnMut(&'static str, usize) -> Result<Sample, String>> Executor for Fake<F> {
    fn render(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        let name = entry.strategy.name;
        let result = (self.answer)(name, self.calls.iter().filter(|&&call| call == name).count());
        self.calls.push(name);
        self.clock += Duration::from_nanos(result.as_ref().map_or(0, |sample| sample.render_ns));
        result
    }

    fn elapsed(&self) -> Duration {
        self.clock
    }

    fn is_interrupted(&self) -> bool {
        self.calls.len() >= self.interrupted_in
    }
}

pub(super) fn fake<F: FnMut(&'static str, usize) -> Result<Sample, String>>(answer: F) -> Fake<F> {
    Fake { answer, calls: Vec::new(), clock: Duration::ZERO, interrupted_in: usize::MAX }
}

pub(super) fn image(brightness: f32) -> Digest {
    Image::filled(1, 1, [brightness; 3]).expect("a pixel").digest()
}

pub(super) fn right(render_ns: u64) -> Result<Sample, String> {
    Ok(Sample::new(7, render_ns, image(1.0)))
}

pub(super) fn wrong(render_ns: u64) -> Result<Sample, String> {
    right(render_ns).map(|sample| Sample { digest: image(0.5), ..sample })
}

pub(super) fn entry(strategy: Strategy<'static>, threads: usize) -> Entry<'static> {
    Entry { strategy, threads: NonZeroUsize::new(threads).expect("not 0") }
}

pub(super) fn protocol(min_rounds: usize, max_rounds: usize, budget_ns: u64) -> Protocol {
    Protocol {
        min_rounds,
        max_rounds,
        budget: Duration::from_nanos(budget_ns),
        goal: None,
        seed: 3,
    }
}

fn run<F: FnMut(&'static str, usize) -> Result<Sample, String>>(
    protocol: Protocol,
    executor: &mut Fake<F>,
) -> Comparison {
    let entries = [entry(POOL, 2), entry(QUEUE, 4)];
    protocol.run(REFERENCE, &entries, executor, |_| {}).expect("a reference image")
}

#[test]
fn every_round_measures_every_row_once_in_an_order_that_varies() {
    let mut executor = fake(|_, _| right(1));
    let comparison = run(protocol(8, 8, u64::MAX), &mut executor);

    assert_eq!(comparison.rounds, 8);
    let (before, measured) = executor.calls.split_at(1 + 4);
    assert_eq!(before, ["reference", "reference", "reference", "pool", "queue"]);
    let rounds: Vec<&[&str]> = measured.chunks(4).collect();
    assert_eq!(rounds.len(), 8);
    for round in &rounds {
        let mut names = round.to_vec();
        names.sort_unstable();
        assert_eq!(names, ["pool", "queue", "reference", "reference"]);
    }
    assert!(rounds.iter().any(|round| round != &rounds[0]), "never shuffled");

    let mut again = fake(|_, _| right(1));
    run(protocol(8, 8, u64::MAX), &mut again);
    assert_eq!(again.calls, executor.calls, "the same seed, another order");
}

#[test]
fn rows_are_reference_control_and_contenders() {
    let entries = [entry(REFERENCE, 4), entry(POOL, 2)];
    let mut executor = fake(|_, _| right(1));
    let comparison =
        protocol(1, 1, 0).run(REFERENCE, &entries, &mut executor, |_| {}).expect("an image");
    let rows: Vec<_> =
        comparison.rows.iter().map(|row| (&*row.strategy, row.threads, row.control)).collect();
    assert_eq!(rows, [("reference", 1, false), ("reference", 1, true), ("pool", 2, false)]);
}

#[test]
fn the_warm_up_is_verified_and_not_counted() {
    // The first calls are a thousand times slower than the rest.
    let mut executor = fake(|_, call| right(if call == 0 { 100_000 } else { 100 }));
    let comparison = run(protocol(5, 5, u64::MAX), &mut executor);
    for row in &comparison.rows[2..] {
        assert_eq!((&row.samples_ns, &row.prepare_samples_ns), (&vec![100; 5], &vec![7; 5]));
    }

    let mut executor =
        fake(|name, call| if name == "pool" && call == 0 { wrong(1) } else { right(1) });
    let comparison = run(protocol(5, 5, u64::MAX), &mut executor);
    assert!(!comparison.rows[2].identical && comparison.rows[2].samples_ns.is_empty());
}

#[test]
fn a_speedup_is_the_median_of_the_ratios_within_a_round() {
    // Rounds slow down by a factor that all rows share. The pool takes half of the reference's
    // time.
    let mut executor = fake(|name, call| {
        // The reference is called three times before the first round, and twice in each.
        let round =
            if name == "reference" { call.saturating_sub(3) / 2 } else { call.saturating_sub(1) };
        let slow = 1000 << round;
        right(if name == "pool" { slow / 2 } else { slow })
    });
    let comparison = run(protocol(5, 5, u64::MAX), &mut executor);
    let [_, control, pool, queue] = &comparison.rows[..] else { panic!("four rows") };
    let exactly = |ratio| Some(Interval::exactly(ratio));
    assert_eq!((pool.speedup, control.speedup), (exactly(2.0), exactly(1.0)));
    assert_eq!((pool.efficiency, pool.serial_fraction), (Some(1.0), Some(0.0)));
    assert_eq!((pool.median_ns, pool.prepare_ns), (Some(2000), Some(7)));
    assert_eq!((queue.efficiency, queue.serial_fraction), (Some(0.25), Some(1.0)));
}

#[test]
fn a_wrong_image_ends_its_row_and_no_other() {
    // Wrong in the third round, after the warm-up and two right ones.
    let mut executor =
        fake(|name, call| if name == "pool" && call >= 3 { wrong(1) } else { right(4) });
    let comparison = run(protocol(6, 6, u64::MAX), &mut executor);
    let pool = &comparison.rows[2];
    assert!(!pool.identical && !pool.passed() && !comparison.passed());
    assert_eq!(pool.digest, Some(image(0.5)));
    assert_eq!(pool.samples_ns.len(), 2, "the time of a wrong image is not a sample");
    assert_eq!((pool.median_ns, pool.speedup), (None, None));
    assert_eq!(executor.calls.iter().filter(|&&name| name == "pool").count(), 4);

    let queue = &comparison.rows[3];
    assert!(queue.passed() && queue.speedup.is_some());
    assert_eq!((queue.samples_ns.len(), queue.digest), (6, Some(comparison.digest)));
}

/// Catches a first image that is not verified, and its time counted in that of the second.
#[test]
fn both_images_of_a_fresh_process_are_verified() {
    let both = |render_ns, cold| {
        right(render_ns).map(|sample| Sample {
            cold_ns: Some(3 * render_ns),
            cpu_ns: Some(2 * render_ns),
            cold_digest: Some(image(cold)),
            ..sample
        })
    };
    let mut executor = fake(|name, call| match (name, call) {
        ("pool", _) => both(5, 1.0),
        ("queue", 3..) => both(10, 0.5),
        _ => both(10, 1.0),
    });
    let comparison = run(protocol(6, 6, u64::MAX), &mut executor);
    let [_, _, pool, queue] = &comparison.rows[..] else { panic!("four rows") };
    assert_eq!((pool.median_ns, pool.cpu_ns, pool.cold_ns), (Some(5), Some(10), Some(15)));
    assert_eq!(pool.cold_speedup, Some(Interval::exactly(2.0)));
    assert!(!queue.identical && queue.samples_ns.len() == 2);
    assert_eq!((queue.digest, &queue.error), (Some(image(0.5)), &None));

    let comparison = run(protocol(1, 1, 0), &mut fake(|_, _| right(1)));
    let pool = &comparison.rows[2];
    assert_eq!((pool.cold_ns, pool.cold_speedup, pool.cpu_ns), (None, None, None));
    assert!(pool.speedup.is_some());
}

#[test]
fn an_error_ends_its_row_and_no_other() {
    let mut executor =
        fake(
            |name, call| {
                if name == "queue" && call == 2 { Err("no threads".to_owned()) } else { right(4) }
            },
        );
    let comparison = run(protocol(6, 6, u64::MAX), &mut executor);
    let queue = &comparison.rows[3];
    assert_eq!(queue.error.as_deref(), Some("no threads"));
    assert!(!queue.passed() && queue.identical, "the images before the error were right");
    assert_eq!((queue.samples_ns.len(), queue.speedup), (1, None));
    assert_eq!(comparison.rows[2].samples_ns.len(), 6);

    let mut executor =
        fake(|name, _| if name == "queue" { Err("no threads".to_owned()) } else { right(4) });
    let comparison = run(protocol(1, 1, 0), &mut executor);
    assert!(!comparison.rows[3].identical, "without an image nothing is identical");
}

#[test]
fn without_a_right_reference_there_are_no_figures() {
    let failures: [fn() -> Result<Sample, String>; 2] =
        [|| wrong(1), || Err("no memory".to_owned())];
    for failure in failures {
        // The image, the warm-up of the reference and its control, two rounds of both, then the
        // third round.
        let mut executor =
            fake(|name, call| if name == "reference" && call >= 7 { failure() } else { right(4) });
        let comparison = run(protocol(6, 6, u64::MAX), &mut executor);
        assert!(
            !comparison.rows[0].passed() && comparison.rows[2].passed() && !comparison.passed()
        );
        assert!(
            comparison.rows.iter().all(|row| row.speedup.is_none() && row.samples_ns.len() >= 2)
        );
    }
}

/// Catches many complete rounds that are lost with one process of the reference.
#[test]
fn rounds_before_a_failure_of_the_reference_count() {
    // Its image, its warm-up and its control's, then two samples a round: the tenth round fails.
    let failing = |name: &str, call: usize| {
        if name == "reference" && call >= 3 + 2 * 9 { Err("killed".to_owned()) } else { right(10) }
    };
    let comparison = run(protocol(20, 20, 0), &mut fake(failing));
    let [reference, .., queue] = &comparison.rows[..] else { panic!("rows") };
    assert_eq!(reference.error.as_deref(), Some("killed"));
    assert!((reference.speedup, comparison.passed()) == (None, false));
    assert_eq!((comparison.rounds, queue.samples_ns.len()), (9, 9));
    assert_eq!(queue.speedup.map(|speedup| speedup.median), Some(1.0));
}

#[test]
fn a_failing_reference_is_an_error() {
    let mut executor = fake(|_, _| Err("broken".to_owned()));
    let result = protocol(1, 1, 0).run(REFERENCE, &[], &mut executor, |_| {});
    assert_eq!(result.expect_err("no image").to_string(), "the reference failed: broken");
}

#[test]
fn the_least_number_of_rounds_is_enough_for_an_interval() {
    let Protocol { min_rounds, max_rounds, budget, goal, .. } = Protocol::default();
    assert_eq!((min_rounds, max_rounds, budget, goal), (8, 40, Duration::from_secs(60), None));
}

/// Catches a time limit that ends after the default number of rounds.
#[test]
fn a_time_limit_is_the_only_limit() {
    assert_eq!(Protocol::default().within(None), Protocol::default());
    let limited = Protocol::default().within(Some(Duration::from_secs(7)));
    assert_eq!((limited.min_rounds, limited.max_rounds), (8, 2000));
    assert_eq!(limited.budget, Duration::from_secs(7));
}

#[test]
fn rounds_end_with_the_budget_but_not_before_the_least_number() {
    let rounds = |protocol| run(protocol, &mut fake(|_, _| right(10))).rounds;
    // The reference's image takes 10, the warm-up and each round 40: five rounds end at 250.
    assert_eq!(rounds(protocol(1, 100, 250)), 5);
    assert_eq!(rounds(protocol(1, 100, 249)), 4, "a round that would not end in time is not begun");
    assert_eq!(rounds(protocol(3, 100, 0)), 3);
    assert_eq!(rounds(protocol(0, 100, 0)), 1);
    assert_eq!(rounds(protocol(1, 7, u64::MAX)), 7);
}

#[test]
fn progress_only_grows_and_stays_below_one() {
    let mut fractions = Vec::new();
    let mut executor = fake(|_, _| right(10));
    let protocol = protocol(3, 10, 300);
    protocol.run(REFERENCE, &[], &mut executor, |p| fractions.push(p.fraction)).expect("an image");
    assert!(fractions.is_sorted(), "{fractions:?}");
    assert!(fractions.iter().all(|fraction| (0.0..1.0).contains(fraction)), "{fractions:?}");
    assert!(fractions.last() > Some(&0.8), "{fractions:?}");
}

/// An executor that counts rays in the warm-up: two for each thread, one of them redundant.
struct Counting<E>(E);

impl<E: Executor> Executor for Counting<E> {
    fn render(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        self.0.render(entry)
    }

    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        let threads = entry.threads.get() as u64;
        let (primary_rays, redundant_rays) = (Some(2 * threads), Some(threads));
        self.0.render(entry).map(|sample| Sample { primary_rays, redundant_rays, ..sample })
    }

    fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }
}

#[test]
fn rays_are_those_of_a_right_image_in_the_warm_up() {
    let mut executor = Counting(fake(|name, call| match (name, call) {
        ("pool", 0) => wrong(1),
        ("queue", 2) => Err("tired".to_owned()),
        _ => right(1),
    }));
    let entries = [entry(POOL, 2), entry(QUEUE, 4)];
    let comparison =
        protocol(3, 3, u64::MAX).run(REFERENCE, &entries, &mut executor, |_| {}).expect("an image");
    let rays = comparison.rows.iter().map(|row| (row.primary_rays, row.redundant_rays));
    let counted = |threads| (Some(2 * threads), Some(threads));
    assert!(rays.eq([counted(1), counted(1), (None, None), counted(4)]));

    let comparison = run(protocol(1, 1, 0), &mut fake(|_, _| right(1)));
    assert!(comparison.rows.iter().all(|row| row.primary_rays.is_none()), "not counted");
}
