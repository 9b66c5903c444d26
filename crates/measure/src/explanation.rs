//! Why strategies lose what they lose: renderings that are recorded beside renderings that are not,
//! in the same interleaved rounds.
//!
//! What is explained is the loss of the quickest plain renderings: what slows a rendering down from
//! outside is no fault of its strategy. The explanation is that of the quickest recorded ones, the
//! cost of recording taken off. Their accounts add up exactly; how far they miss the plain ones is
//! part of the result. Source for the quickest: Chen and Revels, "Robust benchmarking in noisy
//! environments", 2016.

use crate::catch_panic::catch_panic;
use crate::efficiency::{LostTime, TimeBreakdown};
use crate::in_process::nanoseconds;
use crate::rounds::Protocol;
use crate::sentinel;
use crate::statistics::{Interval, ratio_interval};
use crate::timeline::{RecordingCost, TimeRecorder, Timeline};
use rayweave_contract::{Digest, Image, ImageError, Plan, Strategy, Work};
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Instant;
use thiserror::Error;

#[cfg(test)]
mod tests;

/// What is rendered, and against what.
#[derive(Clone, Copy)]
pub struct ExplainExperiment<'a> {
    /// What every rendering computes.
    pub work: &'a dyn Work,
    /// Of the image, in pixels.
    pub size: (u32, u32),
    /// The side of a tile, in pixels.
    pub tile: NonZeroU32,
    /// What a loss is measured against, on one thread.
    pub reference: &'a dyn Strategy,
    /// How long to measure.
    pub protocol: Protocol,
}

/// Why nothing was explained.
#[derive(Debug, Error)]
pub enum ExplainError {
    /// There is no such image.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A strategy failed.
    #[error("{0}")]
    Failed(String),
    /// Its times would mean nothing.
    #[error("{strategy}: drew another image than the reference (see `rayweave check`)")]
    Different {
        /// The strategy's name.
        strategy: &'static str,
    },
}

/// What became of the efficiency of some strategies.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// The reference's name.
    pub reference: &'static str,
    /// Its shortest time, in nanoseconds, not recorded.
    pub reference_ns: f64,
    /// In the order asked for.
    pub rows: Vec<ExplainedStrategy>,
    /// Of every image.
    pub digest: Digest,
    /// Rounds measured.
    pub rounds: usize,
    /// What was taken off the recorded times.
    pub cost: RecordingCost,
}

/// What became of the efficiency of one strategy.
#[derive(Clone, Debug)]
pub struct ExplainedStrategy {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The threads it was given.
    pub threads: usize,
    /// Its shortest time, in nanoseconds, not recorded.
    pub wall_ns: f64,
    /// What it loses of its thread-time, in nanoseconds, not recorded: threads times its time, less
    /// the reference's.
    pub lost_ns: f64,
    /// To what. Their sum misses [`ExplainedStrategy::lost_ns`] by what recorded and plain renderings differ in.
    pub lost_time: LostTime,
    /// Recorded over plain time, within a round.
    pub recorded: Interval,
    /// A gap between two pieces that is longer than 999 of 1000 on a single thread, in nanoseconds.
    pub long_gap_ns: f64,
    /// The quickest of the recorded renderings, the cost of recording in it.
    pub timeline: Timeline,
}

impl ExplainedStrategy {
    /// Threads times time, in nanoseconds.
    #[must_use]
    pub fn thread_time_ns(&self) -> f64 {
        self.threads as f64 * self.wall_ns
    }

    /// What the causes do not add up to of the loss, in nanoseconds; below 0 if they are more.
    #[must_use]
    pub fn unexplained_ns(&self) -> f64 {
        self.lost_ns - self.lost_time.total_ns()
    }
}

/// A strategy with a number of threads, recorded or not, and what its renderings gave.
struct Series<'a> {
    strategy: &'a dyn Strategy,
    threads: NonZeroUsize,
    recording: Recording,
    /// For the pieces of a thread.
    room: usize,
    wall_ns: Vec<u64>,
    /// Of the recorded renderings.
    quickest: Option<Recorded>,
}

/// Whether renderings are recorded, and what is kept of it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Recording {
    /// They are plain.
    Off,
    /// The sums.
    Breakdown,
    /// The sums and every piece, which may be as many as pixels.
    Timeline,
}

/// What is kept of a recorded rendering.
struct Recorded {
    wall_ns: u64,
    breakdown: TimeBreakdown,
    long_gap_ns: f64,
    /// Empty unless it is asked for.
    timeline: Timeline,
}

/// Of a strategy, the places of its series.
struct Places {
    /// Recorded, on one thread.
    alone: usize,
    plain: usize,
    recorded: usize,
}

impl ExplainExperiment<'_> {
    /// Explains `strategies` on `threads` threads each. `progress` is told how much is done, 0 to
    /// 1.
    ///
    /// # Errors
    ///
    /// A strategy fails, or draws another image than the reference.
    pub fn run(
        &self,
        strategies: &[&dyn Strategy],
        threads: NonZeroUsize,
        mut progress: impl FnMut(f64),
    ) -> Result<Explanation, ExplainError> {
        let mut image = Image::new(self.size.0, self.size.1)?;
        let cost = RecordingCost::here();
        let mut series = vec![
            Series::new(self.reference, NonZeroUsize::MIN, Recording::Off),
            Series::new(self.reference, NonZeroUsize::MIN, Recording::Breakdown),
        ];
        let mut places = Vec::with_capacity(strategies.len());
        for &strategy in strategies {
            let threads = strategy.threads().computing_threads(threads);
            let mut add = |threads, recording| {
                series.push(Series::new(strategy, threads, recording));
                series.len() - 1
            };
            let recorded = add(threads, Recording::Timeline);
            let alone = if threads.get() == 1 {
                recorded
            } else {
                add(NonZeroUsize::MIN, Recording::Breakdown)
            };
            places.push(Places { alone, plain: add(threads, Recording::Off), recorded });
        }

        let begin = Instant::now();
        let mut digest = None;
        let mut rounds = self.protocol.rounds(series.len());
        while let Some(slot) = rounds.next(begin.elapsed()) {
            progress(slot.fraction);
            let series = &mut series[slot.entry];
            series.render(self, cost, &mut image, slot.round.is_some())?;
            let found = image.digest();
            if *digest.get_or_insert(found) != found {
                return Err(ExplainError::Different { strategy: series.strategy.name() });
            }
        }
        Ok(Explanation {
            reference: self.reference.name(),
            reference_ns: series[0].shortest_ns(),
            rows: places.iter().map(|places| row(&mut series, places, cost)).collect(),
            digest: digest.unwrap_or_else(|| image.digest()),
            rounds: rounds.completed(),
            cost,
        })
    }
}

/// Takes the time line out of the series.
fn row(
    series: &mut [Series<'_>],
    &Places { alone, plain, recorded }: &Places,
    cost: RecordingCost,
) -> ExplainedStrategy {
    let threads = series[plain].threads.get();
    let wall_ns = series[plain].shortest_ns();
    // The first two are the reference's.
    let [sequential, on_one, on_all] =
        [1, alone, recorded].map(|place| series[place].breakdown(cost));
    let over_plain = ratio_interval(&series[recorded].wall_ns, &series[plain].wall_ns);
    ExplainedStrategy {
        strategy: series[plain].strategy.name(),
        threads,
        wall_ns,
        lost_ns: threads as f64 * wall_ns - series[0].shortest_ns(),
        lost_time: LostTime::new(&sequential, &on_one, &on_all),
        recorded: over_plain.unwrap_or(Interval { median: 1.0, low: 1.0, high: 1.0 }),
        long_gap_ns: series[alone].quickest.as_ref().map_or(0.0, |quickest| quickest.long_gap_ns),
        timeline: series[recorded]
            .quickest
            .take()
            .map(|quickest| quickest.timeline)
            .unwrap_or_default(),
    }
}

impl<'a> Series<'a> {
    fn new(strategy: &'a dyn Strategy, threads: NonZeroUsize, recording: Recording) -> Self {
        Self { strategy, threads, recording, room: 0, wall_ns: Vec::new(), quickest: None }
    }

    /// Renders one image, and takes note of it if it `counts`.
    fn render(
        &mut self,
        experiment: &ExplainExperiment<'_>,
        cost: RecordingCost,
        image: &mut Image,
        counts: bool,
    ) -> Result<(), ExplainError> {
        let plan = Plan { threads: self.threads, tile: experiment.tile };
        let recorder = (self.recording != Recording::Off)
            .then(|| TimeRecorder::new(experiment.work, self.threads.get(), self.room));
        let work = recorder.as_ref().map_or(experiment.work, |recorder| recorder as &dyn Work);
        let mut renderer =
            catch_panic(|| self.strategy.prepare(plan)).map_err(ExplainError::Failed)?;
        sentinel::fill(image);
        let begin = Instant::now();
        let result = catch_panic(|| renderer.render(work, image));
        let end = Instant::now();
        result.map_err(ExplainError::Failed)?;

        let timeline = recorder.map(|recorder| recorder.finish(begin, end));
        if let Some(timeline) = &timeline {
            // Half as many again as an even share.
            self.room = timeline.pieces().div_ceil(self.threads.get()) * 3 / 2;
        }
        if !counts {
            return Ok(());
        }
        self.wall_ns.push(nanoseconds(end - begin));
        let is_quicker = |timeline: &Timeline| {
            self.quickest.as_ref().is_none_or(|quickest| timeline.wall_ns < quickest.wall_ns)
        };
        if let Some(timeline) = timeline.filter(is_quicker) {
            self.quickest = Some(Recorded {
                wall_ns: timeline.wall_ns,
                breakdown: TimeBreakdown::of(&timeline, self.threads.get(), cost),
                long_gap_ns: long_gap_ns(&timeline),
                timeline: if self.recording == Recording::Timeline {
                    timeline
                } else {
                    Timeline::default()
                },
            });
        }
        Ok(())
    }

    fn shortest_ns(&self) -> f64 {
        self.wall_ns.iter().min().map_or(0.0, |&ns| ns as f64)
    }

    /// Of the quickest recorded rendering; of none if there is none.
    fn breakdown(&self, cost: RecordingCost) -> TimeBreakdown {
        let of_none = || TimeBreakdown::of(&Timeline::default(), self.threads.get(), cost);
        self.quickest.as_ref().map_or_else(of_none, |quickest| quickest.breakdown)
    }
}

/// Longer than 999 of 1000 gaps between pieces; 0 if there are none.
fn long_gap_ns(timeline: &Timeline) -> f64 {
    let mut gaps: Vec<u64> = timeline.lanes.iter().flat_map(|lane| lane.gaps_ns()).collect();
    let rank = gaps.len() * 999 / 1000;
    if gaps.is_empty() { 0.0 } else { *gaps.select_nth_unstable(rank).1 as f64 }
}
