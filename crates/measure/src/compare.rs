//! The timing protocol: interleaved rounds in which every timed picture is verified.
//!
//! * In each round every row is measured once, as [`schedule`](crate::schedule) has it.
//! * A speed-up is the median over the rounds of the ratio to the reference in the same round.
//! * The reference is measured a second time as the control: its "speed-up" over itself is 1, and
//!   what its interval says instead is the error of the whole table.
//! * Before the rounds each row renders once without being timed, and is verified; its rays are
//!   counted then.
//! * Preparing, poisoning the picture and verifying it lie outside of the timed span.
//! * A row that fails, or gives another picture than the reference, is measured no further and gets
//!   no figures; its samples so far stay. If it is the reference itself, no row gets figures.
//! * A measurement that is [interrupted](Executor::is_interrupted) ends at once, and is of the
//!   complete rounds before.
//! * Several works that give the same picture are measured [together](Protocol::run_together):
//!   their rows take their turns in the same rounds, so times of one over times of another are
//!   ratios within a round too.
//!
//! The protocol has an [`Executor`] do the rendering and the timing, so its logic is tested without
//! either; [`Stopwatch`](crate::stopwatch::Stopwatch) is the real one.

#[cfg(test)]
mod interrupt_tests;
#[cfg(test)]
mod noise_tests;
mod row;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod together_tests;

pub use row::{Figures, OneShot, Role, Row};

use crate::schedule::Protocol;
use crate::statistics::{Interval, LEAST_VALUES, ratio_interval};
use rayweave_contract::{Digest, Strategy};
use row::with_figures;
use std::num::NonZeroUsize;
use std::time::Duration;
use thiserror::Error;

/// A strategy with a number of threads to be measured.
#[derive(Clone, Copy)]
pub struct Entry<'a> {
    /// How the work is spread.
    pub strategy: &'a dyn Strategy,
    /// The number of computing threads.
    pub threads: NonZeroUsize,
}

/// Renders and times.
pub trait Executor {
    /// Prepares `entry`, renders one picture with it, and takes the times of both.
    ///
    /// # Errors
    ///
    /// What the strategy says of its failure.
    fn render(&mut self, entry: &Entry<'_>) -> Result<Rendering, String>;

    /// The same while what is traced is counted, if the executor knows how: its times are no
    /// sample.
    ///
    /// # Errors
    ///
    /// As [`Executor::render`].
    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<(Rendering, Option<Rays>), String> {
        self.render(entry).map(|rendering| (rendering, None))
    }

    /// Time since the executor was made.
    fn elapsed(&self) -> Duration;

    /// Whether somebody wants no more. A rendering during which that happened is no sample, however
    /// it ended.
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// One rendering, timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rendering {
    /// The times.
    pub sample: Sample,
    /// Of the picture.
    pub digest: Digest,
    /// Of the picture of the [one shot](Sample::one_shot_ns), where there was one.
    pub first_digest: Option<Digest>,
}

/// The times of one rendering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// To prepare the strategy, in nanoseconds.
    pub prepare_ns: u64,
    /// To render, in nanoseconds.
    pub render_ns: u64,
    /// To prepare the strategy and render for the first time in a fresh process, in nanoseconds;
    /// the other times are then of a second rendering. `None` where the process is not fresh.
    pub one_shot_ns: Option<u64>,
    /// CPU time of all threads together while rendering, in nanoseconds, where the system tells.
    pub cpu_ns: Option<u64>,
}

/// The primary rays of one rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rays {
    /// All that were traced.
    pub primary: u64,
    /// Those of them that one tile of the whole picture would have done without: neighbouring tiles
    /// each trace the samples that they could share.
    pub redundant: u64,
}

/// How far a comparison is; told before each rendering, outside of any timed span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The strategy that comes next.
    pub strategy: &'static str,
    /// For so many computing threads.
    pub threads: usize,
    /// The rounds done; 0 during the warm-up too.
    pub rounds: usize,
    /// The share that is done, by rounds or by time, whichever ends first: 0 to 1.
    pub fraction: f64,
}

/// The measured rows.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The reference, the control, then the entries in the order given.
    pub rows: Vec<Row>,
    /// Of the picture that every row has to give.
    pub digest: Digest,
    /// Rounds measured.
    pub rounds: usize,
    /// The protocol's seed, of the order within the rounds.
    pub seed: u64,
    /// The protocol's [goal](Protocol::goal).
    pub goal: Option<f64>,
    /// Whether somebody [wanted no more](Executor::is_interrupted) before the protocol had enough.
    pub interrupted: bool,
}

/// Why nothing could be compared.
#[derive(Debug, Error)]
pub enum CompareError {
    /// There is no picture to verify the others with.
    #[error("the reference failed: {0}")]
    Reference(String),
    /// There are too few samples for an interval.
    #[error(
        "interrupted with {0} complete rounds, of fewer than {LEAST_VALUES} there is no table: let it run longer, or \
         take a smaller --size"
    )]
    Interrupted(usize),
}

/// What `render` gives, unless somebody wants no more before or after it.
fn uninterrupted<T>(
    executor: &mut dyn Executor,
    render: impl FnOnce(&mut dyn Executor) -> T,
) -> Option<T> {
    if executor.is_interrupted() {
        return None;
    }
    let result = render(executor);
    (!executor.is_interrupted()).then_some(result)
}

impl Comparison {
    /// Whether every row gave the reference's picture, every time.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.rows.iter().all(Row::holds)
    }

    /// How many rows with figures miss the goal.
    #[must_use]
    pub fn imprecise_rows(&self) -> usize {
        let intervals = self.rows.iter().filter_map(|row| Some(row.figures?.speedup));
        let misses = |interval: &Interval| {
            self.goal.is_some_and(|goal| interval.relative_half_width() > goal)
        };
        intervals.filter(misses).count()
    }

    /// The reference's median time to render, in nanoseconds; `None` without figures.
    #[must_use]
    pub fn reference_ns(&self) -> Option<f64> {
        self.rows.first().and_then(|row| row.figures).map(|figures| figures.median_ns)
    }

    /// What the reference seems to gain on itself: the error of the table.
    #[must_use]
    pub fn control(&self) -> Option<Interval> {
        let control = self.rows.iter().find(|row| row.role == Role::Control)?;
        control.figures.map(|figures| figures.speedup)
    }

    /// How many times as long as here the reference takes in `other`, measured
    /// [together](Protocol::run_together) with this one. `None` unless both have figures.
    #[must_use]
    pub fn gain_over(&self, other: &Self) -> Option<Interval> {
        let times = |comparison: &Self| {
            comparison.rows.first().filter(|row| row.figures.is_some()).map(Row::render_ns)
        };
        ratio_interval(&times(other)?, &times(self)?)
    }
}

impl Protocol {
    /// Measures `reference`, its control and `entries`; entries of the reference itself are left
    /// out, since it is measured anyway.
    ///
    /// # Errors
    ///
    /// There is no reference picture, or it was interrupted too early.
    pub fn run(
        &self,
        reference: &dyn Strategy,
        entries: &[Entry<'_>],
        executor: &mut dyn Executor,
        progress: impl FnMut(Progress),
    ) -> Result<Comparison, CompareError> {
        // One executor, one comparison.
        Ok(self.run_together(reference, entries, &mut [executor], progress)?.swap_remove(0))
    }

    /// A comparison for each executor, as by [`Protocol::run`] but measured in the same rounds.
    /// Each renders a work of its own, and all have to give the picture that the first gives with
    /// `reference`.
    ///
    /// # Errors
    ///
    /// There is no reference picture, or it was interrupted too early.
    pub fn run_together(
        &self,
        reference: &dyn Strategy,
        entries: &[Entry<'_>],
        executors: &mut [&mut dyn Executor],
        mut progress: impl FnMut(Progress),
    ) -> Result<Vec<Comparison>, CompareError> {
        let Some(first) = executors.first_mut() else { return Ok(Vec::new()) };
        let base = Entry { strategy: reference, threads: NonZeroUsize::MIN };
        let contenders = entries.iter().filter(|entry| entry.strategy.name() != reference.name());
        let entries: Vec<Entry<'_>> = [base, base].into_iter().chain(contenders.copied()).collect();
        let roles = || {
            [Role::Reference, Role::Control].into_iter().chain(std::iter::repeat(Role::Contender))
        };
        let new_rows =
            || entries.iter().zip(roles()).map(|(entry, role)| Row::new(entry, role)).collect();

        let rendering = uninterrupted(&mut **first, |executor| executor.render(&base));
        let digest =
            rendering.ok_or(CompareError::Interrupted(0))?.map_err(CompareError::Reference)?.digest;
        let mut tables: Vec<Vec<Row>> = executors.iter().map(|_| new_rows()).collect();
        let mut schedule = self.schedule(tables.len() * entries.len());
        let mut running = vec![true; tables.len()];
        let mut next_look = self.min_rounds.max(1);
        let mut interrupted_after = None;
        while let Some(turn) = schedule.next(executors[0].elapsed()) {
            // Without its reference a round says nothing.
            if turn.first {
                running = tables.iter().map(|rows| rows[0].holds()).collect();
            }
            if !running.contains(&true) {
                break;
            }
            // Not after each round: the more often one looks, the likelier an interval is narrow by
            // chance.
            if let Some(rounds) = turn.round.filter(|&rounds| turn.first && rounds >= next_look) {
                if self.is_precise(&tables) {
                    break;
                }
                next_look = rounds + rounds.div_ceil(8);
            }
            let (table, entry) = (turn.entry / entries.len(), turn.entry % entries.len());
            let (row, entry) = (&mut tables[table][entry], &entries[entry]);
            if !running[table] || !row.holds() {
                continue;
            }
            progress(Progress {
                strategy: row.strategy,
                threads: row.threads,
                rounds: turn.round.unwrap_or(0),
                fraction: turn.fraction,
            });
            let result = uninterrupted(&mut *executors[table], |executor| match turn.round {
                None => executor.warm_up(entry),
                Some(_) => executor.render(entry).map(|rendering| (rendering, None)),
            });
            let Some(result) = result else {
                interrupted_after = Some(turn.round.unwrap_or(0));
                break;
            };
            match turn.round {
                None => row.warm_up(result, digest),
                Some(_) => row.measure(result.map(|(rendering, _)| rendering), digest),
            }
        }

        if let Some(complete) = interrupted_after {
            if complete < LEAST_VALUES {
                return Err(CompareError::Interrupted(complete));
            }
            // Of every row as many: what the broken round left behind has no counterpart.
            tables.iter_mut().flatten().for_each(|row| row.samples.truncate(complete));
        }
        let rounds = interrupted_after.unwrap_or(schedule.rounds());
        let (seed, goal, interrupted) = (self.seed, self.goal, interrupted_after.is_some());
        let comparison =
            |rows| Comparison { rows: with_figures(rows), digest, rounds, seed, goal, interrupted };
        Ok(tables.into_iter().map(comparison).collect())
    }

    /// Whether every row that will have figures is as precise as was wished for.
    fn is_precise(&self, tables: &[Vec<Row>]) -> bool {
        let precise = |rows: &Vec<Row>, goal| rows.iter().all(|row| row.is_precise(&rows[0], goal));
        // Without its reference a table gets no figures.
        let mut running = tables.iter().filter(|rows| rows[0].holds());
        self.goal.is_some_and(|goal| running.all(|rows| precise(rows, goal)))
    }
}
