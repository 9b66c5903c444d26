//! What more threads would make of an image, from measured costs, and beside it what the threads
//! here make of it.
//!
//! * Every strategy is timed on the numbers of threads that this machine has, by the
//!   [protocol](crate::compare) of a comparison.
//! * In the same rounds [independent](crate::independent) threads draw the whole image each: so
//!   much slower is every piece taken to be beside other threads.
//! * And in the same rounds one thread draws the image [piece by piece](crate::piece_costs) and
//!   times each.
//! * The costs of [threads](crate::calibration) are measured apart, before.
//! * From these alone the [simulation](rayweave_predict) predicts all speed-ups. Nothing of it is
//!   fitted to the times of the strategies.

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
use std::num::{NonZeroU32, NonZeroUsize};
use thiserror::Error;

/// What is predicted.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// What is rendered.
    pub work: &'a dyn Work,
    /// Of the image, in pixels.
    pub size: (u32, u32),
    /// The side of a tile, in pixels.
    pub tile: NonZeroU32,
    /// What speed-ups are against.
    pub reference: &'a dyn Strategy,
    /// Those that start no threads are left out.
    pub strategies: &'a [&'a dyn Strategy],
    /// Numbers of threads, the smallest first.
    pub threads: &'a [NonZeroUsize],
    /// Threads that can be measured here.
    pub available: NonZeroUsize,
    /// Of what is measured.
    pub protocol: Protocol,
}

/// The answer.
#[derive(Clone, Debug)]
pub struct Forecast {
    /// One a strategy.
    pub curves: Vec<ForecastCurve>,
    /// Why strategies are missing.
    pub unavailable: Vec<String>,
    /// How many times as long as alone a thread takes beside others that share nothing with it, by
    /// the number of all.
    pub slowdowns: Vec<(usize, Interval)>,
    /// What was measured.
    pub comparison: Comparison,
}

/// A strategy on ever more threads.
#[derive(Clone, Debug, PartialEq)]
pub struct ForecastCurve {
    /// Its name.
    pub strategy: &'static str,
    /// As measured here.
    pub overheads: Overheads,
    /// In the order of the numbers of threads asked for.
    pub points: Vec<ForecastPoint>,
    /// Of what the strategy makes of its own single thread, all points together; `None` of too few.
    pub amdahl: Option<Law>,
    /// As `amdahl`.
    pub usl: Option<Law>,
}

/// A strategy on a number of threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForecastPoint {
    /// The number of computing threads.
    pub threads: usize,
    /// As predicted, against the reference.
    pub predicted: f64,
    /// As measured; `None` for more threads than here, and where images were wrong.
    pub measured: Option<Interval>,
}

impl ForecastPoint {
    /// By what share the prediction is above what was measured.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        self.measured.map(|measured| self.predicted / measured.median - 1.0)
    }
}

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Threads, locks and counters are timed.
    Overheads,
    /// Strategies and pieces are timed.
    Renderings,
}

/// Why there is no forecast.
#[derive(Debug, Error)]
pub enum ForecastError {
    /// There is nothing to compare with.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// There is no such image.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// What a strategy says.
    #[error("{0}")]
    Strategy(String),
    /// No strategy that starts threads.
    #[error(
        "there is nothing to predict of a strategy without threads: name one that starts threads"
    )]
    Nothing,
}

impl Question<'_> {
    /// Measures and predicts; `progress` is told the share of a stage that is done, between timed
    /// spans.
    ///
    /// # Errors
    ///
    /// No image of this size, no strategy that starts threads, or one that fails though it could
    /// be prepared.
    pub fn answer(&self, mut progress: impl FnMut(Stage, f64)) -> Result<Forecast, ForecastError> {
        let mut unavailable = Vec::new();
        let mut strategies = Vec::new();
        for &strategy in self.strategies.iter().filter(|s| s.threads() != Threads::None) {
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
        let kinds: Vec<Granularity> =
            strategies.iter().map(|strategy| strategy.policy().granularity).collect();
        let pieces: Vec<OneByOne> =
            Cut::for_pieces(&kinds).into_iter().map(OneByOne::new).collect();

        let timed = strategies
            .iter()
            .flat_map(|&strategy| here.iter().map(move |&threads| Entry { strategy, threads }));
        let beside = several.iter().map(|&threads| Entry { strategy: &independent, threads });
        let alone = pieces.iter().map(|strategy| Entry { strategy, threads: NonZeroUsize::MIN });
        let entries: Vec<Entry<'_>> = timed.chain(beside).chain(alone).collect();
        let mut executor = InProcessExecutor::new(self.work, self.size.0, self.size.1, self.tile)?;
        let comparison = self.protocol.run(self.reference, &entries, &mut executor, |at| {
            progress(Stage::Renderings, at.fraction);
        })?;

        let Some(reference) = comparison.reference_ns() else {
            // No row has figures, and the reference's says why.
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
            find(&comparison, independent.name(), threads)?.median_ns?;
            Some((threads, independent.slowdown(threads, &reference_ns)?))
        };
        let slowdowns: Vec<(usize, Interval)> = several.iter().filter_map(slowdown_of).collect();
        let speedup =
            |pieces: &OneByOne| Some(find(&comparison, pieces.name(), 1)?.speedup?.median);
        let measured: Vec<_> =
            pieces.iter().filter_map(|pieces| Some((pieces, speedup(pieces)?))).collect();
        let costs = PieceCosts::new(&measured, reference);
        let curve = |(strategy, overheads): (&&dyn Strategy, &Overheads)| {
            let policy = strategy.policy();
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
                let row = find(&comparison, strategy.name(), threads);
                let measured = row.and_then(|row| row.speedup);
                ForecastPoint { threads, predicted: reference / time, measured }
            });
            ForecastCurve {
                strategy: strategy.name(),
                overheads: *overheads,
                points: points.collect(),
                amdahl: amdahl(&own),
                usl: usl(&own),
            }
        };
        // Whose pieces could not be timed has no curve, and the row of these pieces says why.
        let known = strategies
            .iter()
            .zip(&overheads)
            .filter(|(strategy, _)| costs.know(strategy.policy().granularity));
        let curves = known.map(curve).collect();
        Ok(Forecast { curves, unavailable, slowdowns, comparison })
    }
}

fn find<'a>(comparison: &'a Comparison, strategy: &str, threads: usize) -> Option<&'a Measurement> {
    comparison.rows.iter().find(|row| row.strategy == strategy && row.threads == threads)
}

/// For so many threads: that of the largest number measured that is not larger, and so of all
/// threads here for any more.
fn slowdown(slowdowns: &[(usize, Interval)], threads: usize) -> f64 {
    let known = slowdowns.iter().rfind(|(measured, _)| *measured <= threads);
    // Company makes no thread faster: below 1 is chance.
    known.map_or(1.0, |(_, slowdown)| slowdown.median.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slowdown_of_the_most_threads_measured_is_that_of_all_more() {
        let at = |median| Interval { median, low: median, high: median };
        let slowdowns = [(2, at(1.25)), (4, at(1.5))];
        let expected = [(1, 1.0), (2, 1.25), (3, 1.25), (4, 1.5), (1024, 1.5)];
        for (threads, factor) in expected {
            assert_eq!(slowdown(&slowdowns, threads), factor, "{threads} threads");
        }
        assert_eq!(slowdown(&[], 8), 1.0);
        assert_eq!(slowdown(&[(2, at(0.9))], 8), 1.0);
    }

    #[test]
    fn a_difference_is_relative_to_what_was_measured() {
        let measured = Some(Interval { median: 1.6, low: 1.5, high: 1.7 });
        let point = ForecastPoint { threads: 2, predicted: 2.0, measured };
        assert_eq!(point.difference(), Some(0.25));
        assert_eq!(ForecastPoint { measured: None, ..point }.difference(), None);
    }
}
