//! Measures the overheads of a strategy that a simulation needs, from outside and on synthetic
//! work.

use crate::overhead::{of_pixels, step};
use crate::statistics::lower_quartile;
use crate::synthetic::Synthetic;
use crate::timed_image::{DispatchProbe, TimedImage};
use rayweave_contract::{Granularity, Output, Policy, Renderer, Scheduling, Strategy};
use rayweave_predict::{Access, Overheads, simulate};
use std::num::NonZeroUsize;

/// The number of times that everything is rendered; the lower quartile is used.
const REPETITIONS: usize = 25;

/// A piece long enough for every thread to get one, in nanoseconds.
const LONG_PIECE: f64 = 200e3;

/// The number of pieces of the rendering half of which must be stolen, and the nanoseconds of each.
const STOLEN: (u32, f64) = (64, 10e3);

/// Measures the overheads of `strategies` in interleaved rounds, on one and on `threads` threads.
///
/// # Errors
///
/// The reference, which steps are timed with, or one of the strategies fails, with this message.
pub fn calibrate(
    reference: Strategy<'_>,
    strategies: &[Strategy<'_>],
    threads: NonZeroUsize,
    mut progress: impl FnMut(f64),
) -> Result<Vec<Overheads>, String> {
    let mut workloads = Workloads::new(step(reference)?, threads)?;
    let mut rounds = vec![Vec::new(); strategies.len()];
    for repetition in 0..REPETITIONS {
        progress(repetition as f64 / REPETITIONS as f64);
        for (&strategy, rounds) in strategies.iter().zip(&mut rounds) {
            let mut one = of_pixels(strategy, NonZeroUsize::MIN)?;
            let mut all = of_pixels(strategy, threads)?;
            rounds.push(workloads.time(&mut one, &mut all)?);
        }
    }
    let of = |(strategy, rounds): (&Strategy<'_>, &Vec<Times>)| {
        overheads(strategy.policy, threads.get(), &Times::least_disturbed(rounds))
    };
    Ok(strategies.iter().zip(&rounds).map(of).collect())
}

/// The images to render.
struct Workloads {
    probe: DispatchProbe,
    single: TimedImage,
    /// One long piece, and one twice as long.
    alone: [TimedImage; 2],
    /// One long piece for each thread, and one twice as long for each.
    together: [TimedImage; 2],
    /// A load spread evenly over the pieces.
    spread: TimedImage,
    /// The same load in the second half of the pieces.
    late: TimedImage,
}

impl Workloads {
    fn new(step_ns: f64, threads: NonZeroUsize) -> Result<Self, String> {
        let steps = |ns: f64| (ns / step_ns).round() as u32;
        let threads = u32::try_from(threads.get()).unwrap_or(u32::MAX);
        let (long, (pieces, ns)) = (steps(LONG_PIECE), STOLEN);
        let late = steps(ns);
        Ok(Self {
            probe: DispatchProbe::new()?,
            single: TimedImage::column(1, 0)?,
            alone: [TimedImage::column(1, long)?, TimedImage::column(1, 2 * long)?],
            together: [TimedImage::column(threads, long)?, TimedImage::column(threads, 2 * long)?],
            spread: TimedImage::column(pieces, steps(ns / 2.0))?,
            late: TimedImage::new(
                Synthetic(move |_, y| if y < pieces / 2 { 0 } else { late }),
                1,
                pieces,
            )?,
        })
    }

    fn time(&mut self, one: &mut Renderer, all: &mut Renderer) -> Result<Times, String> {
        Ok(Times {
            single: self.single.time(one)?,
            dispatch_one: self.probe.time(one)?,
            dispatch_all: self.probe.time(all)?,
            alone: [self.alone[0].time(one)?, self.alone[1].time(one)?],
            together: [self.together[0].time(all)?, self.together[1].time(all)?],
            spread: self.spread.time(all)?,
            late: self.late.time(all)?,
        })
    }
}

/// The times of the images of [`Workloads`], in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Times {
    single: f64,
    dispatch_one: [f64; 2],
    dispatch_all: [f64; 2],
    alone: [f64; 2],
    together: [f64; 2],
    spread: f64,
    late: f64,
}

impl Times {
    /// Returns the lower quartile of each time, before any are subtracted.
    fn least_disturbed(rounds: &[Self]) -> Self {
        let of = |of: fn(&Self) -> f64| {
            lower_quartile(&rounds.iter().map(of).collect::<Vec<_>>()).unwrap_or(0.0)
        };
        Self {
            single: of(|times| times.single),
            dispatch_one: [of(|times| times.dispatch_one[0]), of(|times| times.dispatch_one[1])],
            dispatch_all: [of(|times| times.dispatch_all[0]), of(|times| times.dispatch_all[1])],
            alone: [of(|times| times.alone[0]), of(|times| times.alone[1])],
            together: [of(|times| times.together[0]), of(|times| times.together[1])],
            spread: of(|times| times.spread),
            late: of(|times| times.late),
        }
    }
}

/// Returns the overheads that `times` give.
///
/// A measurement from outside cannot tell which part of a piece's dispatch is a critical section.
/// Where all threads share something, the part of dispatch that does not scale is modelled as a
/// critical section, and the time that several threads add to dispatch as its handover.
fn overheads(policy: Policy, threads: usize, times: &Times) -> Overheads {
    // A slope below 0 is noise.
    let dispatch = |times| DispatchProbe::slope(times).max(0.0);
    let (one, all) = match policy.granularity {
        Granularity::Band => (0.0, 0.0),
        _ => (dispatch(times.dispatch_one), dispatch(times.dispatch_all)),
    };
    let others = threads.saturating_sub(1).max(1) as f64;
    let steals = threads > 1
        && matches!(policy.scheduling, Scheduling::WorkStealing | Scheduling::RecursiveSplit);
    let overheads = Overheads {
        start: times.single,
        // A thread that begins later ends later.
        next_start: (without_pieces(times.together) - without_pieces(times.alone)).max(0.0)
            / others,
        piece: one,
        steal: if steals { steal_cost(policy, threads, times.late - times.spread) } else { 0.0 },
        ..Overheads::default()
    };
    let access = |pieces: f64| Access {
        hold: one.min(all) * pieces,
        handover: (all - one).max(0.0) * pieces,
    };
    let piece = (one - all).max(0.0);
    match (policy.output, policy.scheduling) {
        (Output::Mutex | Output::Channel, _) => {
            Overheads { deliver: access(1.0), piece, ..overheads }
        }
        (Output::InPlace, Scheduling::Dynamic { chunk }) => {
            Overheads { take: access(chunk as f64), piece, ..overheads }
        }
        (Output::InPlace, _) => overheads,
    }
}

/// Returns the time of a rendering without its pieces, from one time and from another with pieces
/// twice as long. Threads that slow each other down make the pieces longer, but not this.
fn without_pieces([single, twice]: [f64; 2]) -> f64 {
    2.0 * single - twice
}

/// Returns the cost of a steal, given that the late load takes `longer` than the spread one. Two
/// simulations give the part that is there without a cost of steals, which is subtracted, and the
/// delay of the end for each nanosecond of a steal, which divides the rest.
fn steal_cost(policy: Policy, threads: usize, longer: f64) -> f64 {
    let late = |steal| simulated_late(policy, threads, steal);
    (longer - late(0.0)).max(0.0) / (late(1.0) - late(0.0)).max(1.0)
}

/// Returns the simulated time that the late load takes longer than the spread one if a steal costs
/// `steal`.
fn simulated_late(policy: Policy, threads: usize, steal: f64) -> f64 {
    let (pieces, ns) = STOLEN;
    let late: Vec<f64> =
        (0..pieces).map(|piece| if piece < pieces / 2 { 0.0 } else { ns }).collect();
    let spread = vec![ns / 2.0; pieces as usize];
    let time = |pieces: &[f64], steal| {
        simulate(policy, threads, pieces, &Overheads { steal, ..Overheads::default() }).time
    };
    time(&late, steal) - time(&spread, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The difference in length of the two columns: 2^14 - 2^8 pieces.
    const PIECES: f64 = 16_128.0;

    fn times(all: f64) -> Times {
        Times {
            single: 7.0,
            dispatch_one: [5.0, 5.0 + 10.0 * PIECES],
            dispatch_all: [5.0, 5.0 + all * PIECES],
            alone: [200.0, 390.0],
            together: [216.0, 416.0],
            spread: 300.0,
            late: 303.0,
        }
    }

    fn of(scheduling: Scheduling, output: Output, all: f64) -> Overheads {
        overheads(Policy { granularity: Granularity::Row, scheduling, output }, 3, &times(all))
    }

    /// Catches a dispatch that is counted twice, or in the wrong place.
    #[test]
    fn dispatch_that_does_not_scale_is_a_critical_section() {
        let plain = Overheads { start: 7.0, next_start: 3.0, piece: 10.0, ..Overheads::default() };
        assert_eq!(of(Scheduling::Static, Output::InPlace, 14.0), plain);
        let steals = Policy {
            granularity: Granularity::Row,
            scheduling: Scheduling::WorkStealing,
            output: Output::InPlace,
        };
        let steal = steal_cost(steals, 3, 3.0);
        assert_eq!(
            of(Scheduling::WorkStealing, Output::InPlace, 6.0),
            Overheads { steal, ..plain }
        );
        let take = Access { hold: 20.0, handover: 8.0 };
        let shared = Scheduling::Dynamic { chunk: 2 };
        assert_eq!(of(shared, Output::InPlace, 14.0), Overheads { piece: 0.0, take, ..plain });
        let deliver = Access { hold: 6.0, handover: 0.0 };
        assert_eq!(of(shared, Output::Mutex, 6.0), Overheads { piece: 4.0, deliver, ..plain });
        assert_eq!(
            of(Scheduling::Static, Output::Channel, 6.0),
            Overheads { piece: 4.0, deliver, ..plain }
        );
    }

    /// Catches a cost of steals or of another thread's start with one thread, and a cost of
    /// dispatch with bands.
    #[test]
    fn bands_have_no_dispatch_and_one_thread_has_no_steals() {
        let policy = |piece| Policy {
            granularity: piece,
            scheduling: Scheduling::RecursiveSplit,
            output: Output::InPlace,
        };
        let faster = Times { together: [150.0, 300.0], ..times(10.0) };
        let expected = Overheads { start: 7.0, piece: 10.0, ..Overheads::default() };
        assert_eq!(overheads(policy(Granularity::Pixel), 1, &faster), expected);
        assert_eq!(
            overheads(policy(Granularity::Band), 1, &faster),
            Overheads { piece: 0.0, ..expected }
        );
    }

    /// Catches an uneven split counted as the cost of a steal, and several steals counted as one.
    #[test]
    fn the_cost_of_a_theft_is_recovered() {
        for (scheduling, threads) in [
            (Scheduling::WorkStealing, 2),
            (Scheduling::WorkStealing, 5),
            (Scheduling::RecursiveSplit, 2),
        ] {
            let policy =
                Policy { granularity: Granularity::Tile, scheduling, output: Output::InPlace };
            let found = steal_cost(policy, threads, simulated_late(policy, threads, 100.0));
            assert!((found - 100.0).abs() < 1.0, "{scheduling:?}, {threads} threads: {found}");
        }
    }

    #[test]
    fn each_time_is_the_lower_quartile() {
        let rounds = [1.0, 2.0, 3.0, 4.0, 5.0].map(|single| Times {
            single,
            late: 9.0 - single,
            ..times(10.0)
        });
        let least = Times { single: 2.0, late: 5.0, ..times(10.0) };
        assert_eq!(Times::least_disturbed(&rounds), least);
    }
}
