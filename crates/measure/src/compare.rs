//! The timing protocol: interleaved rounds in which every timed image is verified.
//!
//! * In each of the [rounds](crate::rounds) every row is measured once.
//! * A speed-up is the median over the rounds of the ratio to the reference in the same round.
//! * The reference is measured a second time as the control. Its true speed-up is 1, so its
//!   interval shows the error of the whole table.
//! * Before the rounds each row renders once without being timed, and is verified; its rays are
//!   counted then.
//! * Preparing, filling the image with the sentinel and verifying it are outside of the timed span.
//! * A row that fails, or gives another image than the reference, is measured no further and gets
//!   no figures; its samples so far stay. If it is the reference itself, no row gets figures.
//! * A measurement that is [interrupted](Executor::is_interrupted) ends at once. Its figures are
//!   those of the complete rounds.
//! * Several works that give the same image are measured [together](Protocol::run_together): their
//!   rows are measured in the same rounds, so times of one over times of another are ratios within
//!   a round too.
//!
//! An [`Executor`] renders and takes the times, so the protocol is tested without either.
//! [`InProcessExecutor`](crate::in_process::InProcessExecutor) renders in this process.

#[cfg(test)]
mod interrupt_tests;
#[cfg(test)]
mod noise_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod together_tests;

use crate::measurement::{Measurement, Sample, compute_figures};
use crate::rounds::Protocol;
use crate::statistics::LEAST_VALUES;
use rayweave_contract::{Digest, Strategy};
use std::num::NonZeroUsize;
use std::time::Duration;
use thiserror::Error;

/// A strategy with a number of threads to be measured.
#[derive(Clone, Copy)]
pub struct Entry<'a> {
    /// The strategy.
    pub strategy: Strategy<'a>,
    /// The number of computing threads.
    pub threads: NonZeroUsize,
}

/// Renders an entry and times it.
pub trait Executor {
    /// Prepares `entry`, renders an image with it, and times both.
    ///
    /// # Errors
    ///
    /// The strategy's own message.
    fn render(&mut self, entry: &Entry<'_>) -> Result<Sample, String>;

    /// Renders as [`Executor::render`] does, and counts the rays if the executor knows how. Its
    /// times are not used.
    ///
    /// # Errors
    ///
    /// As [`Executor::render`].
    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        self.render(entry)
    }

    /// Returns the time since the executor was made.
    fn elapsed(&self) -> Duration;

    /// Returns whether the run was interrupted. A rendering during which that happened is not a
    /// sample, however it ended.
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// The progress of a comparison before each rendering, outside of any timed span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareProgress {
    /// The strategy that comes next.
    pub strategy: &'static str,
    /// The number of computing threads.
    pub threads: usize,
    /// The number of rounds done; 0 during the warm-up too.
    pub rounds: usize,
    /// The share that is done, by rounds or by time, whichever ends first: 0 to 1.
    pub fraction: f64,
}

/// The measured rows of a reference, its control and some entries.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The reference, the control, then the entries in the order given.
    pub rows: Vec<Measurement>,
    /// The digest of the image that every row has to give.
    pub digest: Digest,
    /// The number of rounds measured.
    pub rounds: usize,
    /// True if the run was [interrupted](Executor::is_interrupted) before the protocol's end.
    pub interrupted: bool,
}

/// An error that leaves nothing to compare.
#[derive(Debug, Error)]
pub enum CompareError {
    /// The reference failed, so there is no image to verify the others with.
    #[error("the reference failed: {0}")]
    Reference(String),
    /// There are too few samples for an interval.
    #[error(
        "interrupted after {0} complete rounds; a table needs at least {LEAST_VALUES}: let it run \
         longer, or use a smaller --size"
    )]
    Interrupted(usize),
}

/// Returns the result of `render`, or `None` if the run is interrupted before or after it.
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
    /// Returns whether every row gave the reference's image, every time.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.rows.iter().all(Measurement::passed)
    }

    /// Returns the reference's median time to render, in nanoseconds; `None` without figures.
    #[must_use]
    pub fn reference_ns(&self) -> Option<f64> {
        self.rows.first().and_then(|row| row.median_ns).map(|ns| ns as f64)
    }
}

impl Protocol {
    /// Measures `reference`, its control and `entries`; entries of the reference itself are left
    /// out, since it is measured anyway.
    ///
    /// # Errors
    ///
    /// There is no reference image, or it was interrupted too early.
    pub fn run(
        &self,
        reference: Strategy<'_>,
        entries: &[Entry<'_>],
        executor: &mut dyn Executor,
        progress: impl FnMut(CompareProgress),
    ) -> Result<Comparison, CompareError> {
        // There is one comparison, because there is one executor.
        Ok(self.run_together(reference, entries, &mut [executor], progress)?.swap_remove(0))
    }

    /// Measures a comparison for each executor, as [`Protocol::run`] does but in the same rounds.
    /// Each executor renders a work of its own. All have to give the image that the first gives
    /// with `reference`.
    ///
    /// # Errors
    ///
    /// There is no reference image, or it was interrupted too early.
    pub fn run_together(
        &self,
        reference: Strategy<'_>,
        entries: &[Entry<'_>],
        executors: &mut [&mut dyn Executor],
        mut progress: impl FnMut(CompareProgress),
    ) -> Result<Vec<Comparison>, CompareError> {
        let Some(first) = executors.first_mut() else { return Ok(Vec::new()) };
        let base = Entry { strategy: reference, threads: NonZeroUsize::MIN };
        let contenders = entries.iter().filter(|entry| entry.strategy.name != reference.name);
        let entries: Vec<Entry<'_>> = [base, base].into_iter().chain(contenders.copied()).collect();
        // The reference is the first row, its control the second.
        let new_row = |(place, entry): (usize, &Entry<'_>)| {
            Measurement::new(entry.strategy, entry.threads, place == 1)
        };

        let rendering = uninterrupted(&mut **first, |executor| executor.render(&base));
        let digest =
            rendering.ok_or(CompareError::Interrupted(0))?.map_err(CompareError::Reference)?.digest;
        let mut tables: Vec<Vec<Measurement>> =
            executors.iter().map(|_| entries.iter().enumerate().map(new_row).collect()).collect();
        let mut rounds = self.rounds(tables.len() * entries.len());
        let mut running = vec![true; tables.len()];
        let mut next_look = self.min_rounds.max(1);
        let mut interrupted_after = None;
        while let Some(slot) = rounds.next(executors[0].elapsed()) {
            // Without its reference a comparison gets no figures.
            if slot.starts_round {
                running = tables.iter().map(|rows| rows[0].passed()).collect();
            }
            if !running.contains(&true) {
                break;
            }
            // Not after each round: more looks make a narrow interval by chance more likely.
            if let Some(rounds) =
                slot.round.filter(|&rounds| slot.starts_round && rounds >= next_look)
            {
                if self.is_precise(&tables) {
                    break;
                }
                next_look = rounds + rounds.div_ceil(8);
            }
            let (table, entry) = (slot.entry / entries.len(), slot.entry % entries.len());
            let (row, entry) = (&mut tables[table][entry], &entries[entry]);
            if !running[table] || !row.passed() {
                continue;
            }
            progress(CompareProgress {
                strategy: entry.strategy.name,
                threads: row.threads,
                rounds: slot.round.unwrap_or(0),
                fraction: slot.fraction,
            });
            let result = uninterrupted(&mut *executors[table], |executor| match slot.round {
                None => executor.warm_up(entry),
                Some(_) => executor.render(entry),
            });
            let Some(result) = result else {
                interrupted_after = Some(slot.round.unwrap_or(0));
                break;
            };
            match slot.round {
                None => row.warm_up(result, digest),
                Some(_) => row.add(result, digest),
            }
        }

        if let Some(complete) = interrupted_after {
            if complete < LEAST_VALUES {
                return Err(CompareError::Interrupted(complete));
            }
            // Samples of the incomplete round have no counterpart in other rows.
            tables.iter_mut().flatten().for_each(|row| row.truncate(complete));
        }
        let rounds = interrupted_after.unwrap_or(rounds.completed());
        tables.iter_mut().for_each(|rows| compute_figures(rows));
        let interrupted = interrupted_after.is_some();
        let comparison = |rows: Vec<Measurement>| {
            // The round in which the reference failed is incomplete.
            let failed = rows.first().filter(|reference| reference.error.is_some());
            let rounds = failed.map_or(rounds, |reference| reference.samples_ns.len());
            Comparison { rows, digest, rounds, interrupted }
        };
        Ok(tables.into_iter().map(comparison).collect())
    }

    /// Returns whether every row that will have figures is as precise as the goal.
    fn is_precise(&self, tables: &[Vec<Measurement>]) -> bool {
        let precise =
            |rows: &Vec<Measurement>, goal| rows.iter().all(|row| row.is_precise(&rows[0], goal));
        // Without its reference a table gets no figures.
        let mut running = tables.iter().filter(|rows| rows[0].passed());
        self.goal.is_some_and(|goal| running.all(|rows| precise(rows, goal)))
    }
}
