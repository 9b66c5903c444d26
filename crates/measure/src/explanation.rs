//! Explains lost efficiency: renders with and without a recorder in the same interleaved rounds.
//!
//! The loss is that of the quickest plain rendering, because interference from outside only adds
//! time. The causes are those of the quickest recorded rendering, without the cost of recording.
//! They add up exactly to the recorded loss; the difference to the plain loss is part of the
//! result. Source for the quickest: Chen and Revels, "Robust benchmarking in noisy environments",
//! 2016.

use crate::catch_panic::catch_panic;
use crate::efficiency::{LostTime, TimeBreakdown};
use crate::in_process::nanoseconds;
use crate::rounds::Protocol;
use crate::sentinel;
use crate::statistics::{Interval, ratio_interval};
use crate::timeline::{RecordingCost, TimeRecorder, Timeline};
use rayweave_contract::{Digest, Image, ImageError, Plan, Strategy, Work};
use serde::Serialize;
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Instant;
use thiserror::Error;

#[cfg(test)]
mod tests;

/// The renderings to explain, and the reference to explain them against.
#[derive(Clone, Copy)]
pub struct ExplainExperiment<'a> {
    /// The work of every rendering.
    pub work: &'a dyn Work,
    /// The width and height of the image in pixels.
    pub size: (u32, u32),
    /// The side of a tile, in pixels.
    pub tile: NonZeroU32,
    /// The strategy that defines zero loss, on one thread.
    pub reference: Strategy<'a>,
    /// The number of rounds and the time for them.
    pub protocol: Protocol,
}

/// An error that leaves nothing to explain.
#[derive(Debug, Error)]
pub enum ExplainError {
    /// There is no image of this size.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A strategy failed.
    #[error("{0}")]
    Failed(String),
    /// A strategy gave another image than the reference, so its times mean nothing.
    #[error("{strategy}: drew another image than the reference (see `rayweave check`)")]
    Different {
        /// The strategy's name.
        strategy: &'static str,
    },
}

/// The lost efficiency of some strategies.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// The reference's name.
    pub reference: &'static str,
    /// The reference's shortest plain time, in nanoseconds.
    pub reference_ns: f64,
    /// The strategies, in the order asked for.
    pub rows: Vec<ExplainedStrategy>,
    /// The digest of every image.
    pub digest: Digest,
    /// The number of rounds measured.
    pub rounds: usize,
    /// The cost of recording, which the causes do not contain.
    pub cost: RecordingCost,
}

/// The lost efficiency of one strategy. It serializes without the time line.
#[derive(Clone, Debug, Serialize)]
pub struct ExplainedStrategy {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The number of computing threads.
    pub threads: usize,
    /// The shortest plain time, in nanoseconds.
    pub wall_ns: f64,
    /// The plain thread-time that is lost, in nanoseconds: the number of threads times the time,
    /// less the reference's time.
    pub lost_ns: f64,
    /// The lost time by cause. Its sum differs from [`ExplainedStrategy::lost_ns`] as recorded
    /// renderings differ from plain ones.
    #[serde(rename = "losses_ns")]
    pub lost_time: LostTime,
    /// The recorded over the plain time within a round.
    #[serde(rename = "recorded_over_plain")]
    pub recorded: Interval,
    /// The gap between two pieces that is longer than 999 of 1000 on a single thread, in
    /// nanoseconds.
    pub long_gap_ns: f64,
    /// The quickest recorded rendering, with the cost of recording in it.
    #[serde(skip)]
    pub timeline: Timeline,
}

impl ExplainedStrategy {
    /// Returns the number of threads times the time, in nanoseconds.
    #[must_use]
    pub fn thread_time_ns(&self) -> f64 {
        self.threads as f64 * self.wall_ns
    }

    /// Returns the part of the loss that the causes do not explain, in nanoseconds; below 0 if they
    /// add up to more.
    #[must_use]
    pub fn unexplained_ns(&self) -> f64 {
        self.lost_ns - self.lost_time.total_ns()
    }
}

/// The renderings of a strategy with a number of threads, recorded or not.
struct Series<'a> {
    strategy: Strategy<'a>,
    threads: NonZeroUsize,
    recording: Recording,
    /// The number of pieces of a thread that a recorder has memory for.
    room: usize,
    wall_ns: Vec<u64>,
    /// The quickest recorded rendering.
    quickest: Option<Recorded>,
}

/// The data that is kept of a rendering.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Recording {
    /// Nothing but its time: it is plain.
    Off,
    /// The time breakdown.
    Breakdown,
    /// The time breakdown and every piece; there may be as many pieces as pixels.
    Timeline,
}

/// A recorded rendering.
struct Recorded {
    wall_ns: u64,
    breakdown: TimeBreakdown,
    long_gap_ns: f64,
    /// Empty unless it is asked for.
    timeline: Timeline,
}

/// The places of the series of one strategy.
struct Places {
    /// The recorded series on one thread.
    alone: usize,
    plain: usize,
    recorded: usize,
}

impl ExplainExperiment<'_> {
    /// Explains `strategies` on `threads` threads each. `progress` gets the share that is done, 0
    /// to 1.
    ///
    /// # Errors
    ///
    /// A strategy fails, or gives another image than the reference.
    pub fn run(
        &self,
        strategies: &[Strategy<'_>],
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
            let threads = strategy.threads.computing_threads(threads);
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
                return Err(ExplainError::Different { strategy: series.strategy.name });
            }
        }
        Ok(Explanation {
            reference: self.reference.name,
            reference_ns: series[0].shortest_ns(),
            rows: places.iter().map(|places| row(&mut series, places, cost)).collect(),
            digest: digest.unwrap_or_else(|| image.digest()),
            rounds: rounds.completed(),
            cost,
        })
    }
}

/// Returns the row of the series at `places`, and takes their time line.
fn row(
    series: &mut [Series<'_>],
    &Places { alone, plain, recorded }: &Places,
    cost: RecordingCost,
) -> ExplainedStrategy {
    let threads = series[plain].threads.get();
    let wall_ns = series[plain].shortest_ns();
    // The first two series are the reference's.
    let [sequential, on_one, on_all] =
        [1, alone, recorded].map(|place| series[place].breakdown(cost));
    let over_plain = ratio_interval(&series[recorded].wall_ns, &series[plain].wall_ns);
    ExplainedStrategy {
        strategy: series[plain].strategy.name,
        threads,
        wall_ns,
        lost_ns: threads as f64 * wall_ns - series[0].shortest_ns(),
        lost_time: LostTime::new(&sequential, &on_one, &on_all),
        recorded: over_plain.unwrap_or(Interval::exactly(1.0)),
        long_gap_ns: series[alone].quickest.as_ref().map_or(0.0, |quickest| quickest.long_gap_ns),
        timeline: series[recorded]
            .quickest
            .take()
            .map(|quickest| quickest.timeline)
            .unwrap_or_default(),
    }
}

impl<'a> Series<'a> {
    fn new(strategy: Strategy<'a>, threads: NonZeroUsize, recording: Recording) -> Self {
        Self { strategy, threads, recording, room: 0, wall_ns: Vec::new(), quickest: None }
    }

    /// Renders one image, and keeps its data if it `counts`.
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
            // One and a half times an even share.
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

    /// Returns the breakdown of the quickest recorded rendering, or of an empty one.
    fn breakdown(&self, cost: RecordingCost) -> TimeBreakdown {
        let of_none = || TimeBreakdown::of(&Timeline::default(), self.threads.get(), cost);
        self.quickest.as_ref().map_or_else(of_none, |quickest| quickest.breakdown)
    }
}

/// Returns the gap that is longer than 999 of 1000 gaps between pieces; 0 if there are none.
fn long_gap_ns(timeline: &Timeline) -> f64 {
    let mut gaps: Vec<u64> = timeline.lanes.iter().flat_map(|lane| lane.gaps_ns()).collect();
    let rank = gaps.len() * 999 / 1000;
    if gaps.is_empty() { 0.0 } else { *gaps.select_nth_unstable(rank).1 as f64 }
}
