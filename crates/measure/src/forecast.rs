//! Predicts speed-ups on more threads than the machine has, and checks the prediction on as many as
//! it has.
//!
//! * Every strategy is timed on the numbers of threads that this machine has, by the
//!   [protocol](crate::compare) of a comparison.
//! * In the same rounds [independent](crate::independent) threads render the whole image each. The
//!   ratio to one thread alone is how much longer every piece takes beside other threads.
//! * In the same rounds one thread renders the image [piece by piece](crate::piece_costs) and times
//!   each piece.
//! * The costs of [threads](crate::calibration) are measured separately, before.
//! * From these alone the [simulation](rayweave_predict) predicts all speed-ups. It is not fitted
//!   to the times of the strategies.

use crate::calibration::calibrate;
use crate::compare::{CompareError, Comparison, Entry};
use crate::in_process::InProcessExecutor;
use crate::independent::Independent;
use crate::measurement::Measurement;
use crate::overhead::of_pixels;
use crate::piece_costs::{Cut, OneByOne, PieceCosts};
use crate::rounds::Protocol;
use crate::statistics::Interval;
use rayweave_contract::{Granularity, ImageError, Strategy, Threads, Work};
use rayweave_predict::fit::{amdahl, usl};
use rayweave_predict::{Law, Overheads, simulate};
use serde::Serialize;
use std::num::{NonZeroU32, NonZeroUsize};
use thiserror::Error;

/// The strategies and numbers of threads to predict.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// The work to render.
    pub work: &'a dyn Work,
    /// The width and height of the image in pixels.
    pub size: (u32, u32),
    /// The side of a tile, in pixels.
    pub tile: NonZeroU32,
    /// The strategy that speed-ups are relative to.
    pub reference: Strategy<'a>,
    /// The strategies; those that start no threads are left out.
    pub strategies: &'a [Strategy<'a>],
    /// The numbers of threads, in ascending order.
    pub threads: &'a [NonZeroUsize],
    /// The number of threads that can be measured here.
    pub available: NonZeroUsize,
    /// The number of rounds and the time for them.
    pub protocol: Protocol,
}

/// The predicted and the measured speed-ups.
#[derive(Clone, Debug)]
pub struct Forecast {
    /// The curves, one for each strategy.
    pub curves: Vec<ForecastCurve>,
    /// The reasons why strategies are missing.
    pub unavailable: Vec<String>,
    /// The slowdown of threads that share nothing, by their number in ascending order.
    pub slowdowns: Vec<Slowdown>,
    /// The measured times.
    pub comparison: Comparison,
}

/// The slowdown of a thread beside others that share nothing with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slowdown {
    /// The number of all threads.
    pub threads: usize,
    /// The time of a thread beside the others over its time alone.
    pub factor: Interval,
}

/// The speed-ups of a strategy by the number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct ForecastCurve {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The overheads measured here.
    pub overheads: Overheads,
    /// The points, in the order of the numbers of threads asked for.
    pub points: Vec<ForecastPoint>,
    /// Amdahl's law fitted to the predicted speed-ups over the strategy's own single thread; `None`
    /// if there are too few points.
    pub amdahl: Option<Law>,
    /// Gunther's law fitted to the same points.
    pub usl: Option<Law>,
}

/// The speed-up of a strategy on a number of threads, over the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ForecastPoint {
    /// The number of computing threads.
    pub threads: usize,
    /// The predicted speed-up.
    pub predicted: f64,
    /// The measured speed-up; `None` for more threads than the machine has, and where images were
    /// wrong.
    pub measured: Option<Interval>,
}

impl ForecastPoint {
    /// Returns the relative difference of the prediction from the measurement, above 0 if the
    /// prediction is larger.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        self.measured.map(|measured| self.predicted / measured.median - 1.0)
    }
}

/// The stage that a forecast is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Threads, locks and counters are timed.
    Overheads,
    /// Strategies and pieces are timed.
    Renderings,
}

/// An error that leaves no forecast.
#[derive(Debug, Error)]
pub enum ForecastError {
    /// There is nothing to compare with.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// There is no image of this size.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A strategy failed with this message.
    #[error("{0}")]
    Strategy(String),
    /// There is no strategy that starts threads.
    #[error(
        "there is nothing to predict of a strategy without threads: name one that starts threads"
    )]
    Nothing,
}

impl Question<'_> {
    /// Measures and predicts. `progress` gets the share of a stage that is done, between timed
    /// spans.
    ///
    /// # Errors
    ///
    /// There is no image of this size or no strategy that starts threads, or a strategy fails
    /// though it could be prepared.
    pub fn answer(&self, mut progress: impl FnMut(Stage, f64)) -> Result<Forecast, ForecastError> {
        let mut unavailable = Vec::new();
        let mut strategies = Vec::new();
        for &strategy in self.strategies.iter().filter(|s| s.threads != Threads::None) {
            match of_pixels(strategy, NonZeroUsize::MIN) {
                Ok(_) => strategies.push(strategy),
                Err(reason) => unavailable.push(reason),
            }
        }
        if strategies.is_empty() && unavailable.is_empty() {
            return Err(ForecastError::Nothing);
        }
        let overheads = calibrate(self.reference, &strategies, self.available, |done| {
            progress(Stage::Overheads, done);
        })
        .map_err(ForecastError::Strategy)?;
        let here: Vec<NonZeroUsize> =
            self.threads.iter().copied().filter(|threads| *threads <= self.available).collect();
        let together =
            here.iter().filter(|threads| **threads != self.available).chain([&self.available]);
        let several: Vec<NonZeroUsize> =
            together.copied().filter(|threads| threads.get() > 1).collect();
        let independent = Independent::default();
        let beside_others = independent.strategy();
        let kinds: Vec<Granularity> =
            strategies.iter().map(|strategy| strategy.policy.granularity).collect();
        let pieces: Vec<OneByOne> =
            Cut::for_pieces(&kinds).into_iter().map(OneByOne::new).collect();

        let timed = strategies
            .iter()
            .flat_map(|&strategy| here.iter().map(move |&threads| Entry { strategy, threads }));
        let beside = several.iter().map(|&threads| Entry { strategy: beside_others, threads });
        let alone = pieces.iter().map(|one_by_one| Entry {
            strategy: one_by_one.strategy(),
            threads: NonZeroUsize::MIN,
        });
        let entries: Vec<Entry<'_>> = timed.chain(beside).chain(alone).collect();
        let mut executor = InProcessExecutor::new(self.work, self.size.0, self.size.1, self.tile)?;
        let comparison = self.protocol.run(self.reference, &entries, &mut executor, |at| {
            progress(Stage::Renderings, at.fraction);
        })?;

        let Some(reference) = comparison.reference_ns() else {
            // No row has figures; that of the reference has the reason.
            return Ok(Forecast {
                curves: Vec::new(),
                unavailable,
                slowdowns: Vec::new(),
                comparison,
            });
        };
        let reference_ns = comparison.rows[0].samples_ns.clone();
        let slowdown_of = |threads: &NonZeroUsize| {
            let threads = threads.get();
            find(&comparison, beside_others.name, threads)?.median_ns?;
            Some(Slowdown { threads, factor: independent.slowdown(threads, &reference_ns)? })
        };
        let slowdowns: Vec<Slowdown> = several.iter().filter_map(slowdown_of).collect();
        let speedup =
            |pieces: &OneByOne| Some(find(&comparison, pieces.strategy().name, 1)?.speedup?.median);
        let measured: Vec<_> =
            pieces.iter().filter_map(|pieces| Some((pieces, speedup(pieces)?))).collect();
        let costs = PieceCosts::new(&measured, reference);
        let curve = |(strategy, overheads): (&Strategy<'_>, &Overheads)| {
            let policy = strategy.policy;
            let time = |threads: usize| {
                let slowdown = slowdown(&slowdowns, threads);
                let pieces =
                    costs.of(policy.granularity, threads).into_iter().map(|cost| cost * slowdown);
                simulate(policy, threads, &pieces.collect::<Vec<_>>(), overheads).time
            };
            let times: Vec<(usize, f64)> =
                self.threads.iter().map(|threads| (threads.get(), time(threads.get()))).collect();
            let one = time(1);
            let own: Vec<(usize, f64)> =
                times.iter().map(|&(threads, time)| (threads, one / time)).collect();
            let points = times.iter().map(|&(threads, time)| {
                let row = find(&comparison, strategy.name, threads);
                let measured = row.and_then(|row| row.speedup);
                ForecastPoint { threads, predicted: reference / time, measured }
            });
            ForecastCurve {
                strategy: strategy.name,
                overheads: *overheads,
                points: points.collect(),
                amdahl: amdahl(&own),
                usl: usl(&own),
            }
        };
        // A strategy whose pieces could not be timed has no curve; the row of these pieces has the
        // reason.
        let known = strategies
            .iter()
            .zip(&overheads)
            .filter(|(strategy, _)| costs.know(strategy.policy.granularity));
        let curves = known.map(curve).collect();
        Ok(Forecast { curves, unavailable, slowdowns, comparison })
    }
}

fn find<'a>(comparison: &'a Comparison, strategy: &str, threads: usize) -> Option<&'a Measurement> {
    comparison.rows.iter().find(|row| row.strategy == strategy && row.threads == threads)
}

/// Returns the slowdown measured on the largest number of threads up to `threads`.
fn slowdown(slowdowns: &[Slowdown], threads: usize) -> f64 {
    let known = slowdowns.iter().rfind(|known| known.threads <= threads);
    // Other threads make no thread faster: a median below 1 is chance.
    known.map_or(1.0, |known| known.factor.median.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slowdown_of_the_most_threads_measured_is_that_of_all_more() {
        let at = |threads, median| Slowdown { threads, factor: Interval::exactly(median) };
        let slowdowns = [at(2, 1.25), at(4, 1.5)];
        let expected = [(1, 1.0), (2, 1.25), (3, 1.25), (4, 1.5), (1024, 1.5)];
        for (threads, factor) in expected {
            assert_eq!(slowdown(&slowdowns, threads), factor, "{threads} threads");
        }
        assert_eq!(slowdown(&[], 8), 1.0);
        assert_eq!(slowdown(&[at(2, 0.9)], 8), 1.0);
    }

    #[test]
    fn a_difference_is_relative_to_what_was_measured() {
        let measured = Some(Interval { median: 1.6, low: 1.5, high: 1.7 });
        let point = ForecastPoint { threads: 2, predicted: 2.0, measured };
        assert_eq!(point.difference(), Some(0.25));
        assert_eq!(ForecastPoint { measured: None, ..point }.difference(), None);
    }
}
