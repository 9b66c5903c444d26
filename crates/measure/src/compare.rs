//! The timing protocol: interleaved rounds in which every timed picture is verified.
//!
//! * In each round every row is measured once, as [`schedule`](crate::schedule) has it.
//! * A speed-up is the median over the rounds of the ratio to the reference in the same round.
//! * The reference is measured a second time as the control: its "speed-up" over itself is 1, and
//!   what its interval says instead is the error of the whole table.
//! * Before the rounds each row renders once without being timed, and is verified; its rays are counted then.
//! * Preparing, poisoning the picture and verifying it lie outside of the timed span.
//! * A row that fails, or gives another picture than the reference, is measured no further and gets
//!   no figures; its samples so far stay. If it is the reference itself, no row gets figures.
//! * Several works that give the same picture are measured [together](Protocol::run_together): their rows take
//!   their turns in the same rounds, so times of one over times of another are ratios within a round too.
//!
//! The protocol has an [`Executor`] do the rendering and the timing, so its logic is tested without
//! either; [`Stopwatch`](crate::stopwatch::Stopwatch) is the real one.

use crate::schedule::Protocol;
use crate::statistics::{Interval, efficiency, karp_flatt, median, ratio_interval};
use rayweave_core::{Digest, Strategy, ThreadsStart};
use std::num::NonZeroUsize;
use std::time::Duration;
use thiserror::Error;

#[cfg(test)]
mod tests;

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

    /// The same while what is traced is counted, if the executor knows how: its times are no sample.
    ///
    /// # Errors
    ///
    /// As [`Executor::render`].
    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<(Rendering, Option<Rays>), String> {
        self.render(entry).map(|rendering| (rendering, None))
    }

    /// Time since the executor was made.
    fn elapsed(&self) -> Duration;
}

/// One rendering, timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rendering {
    /// The times.
    pub sample: Sample,
    /// Of the picture.
    pub digest: Digest,
}

/// The times of one rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// To prepare the strategy, in nanoseconds.
    pub prepare_ns: u64,
    /// To render, in nanoseconds.
    pub render_ns: u64,
}

/// The primary rays of one rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rays {
    /// All that were traced.
    pub primary: u64,
    /// Those of them that one tile of the whole picture would have done without: neighbouring tiles each trace the
    /// samples that they could share.
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
}

/// What a row is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// What every other row is compared with.
    Reference,
    /// The reference once more.
    Control,
    /// One of the entries.
    Contender,
}

/// A strategy with a number of threads, measured.
#[derive(Clone, Debug)]
pub struct Row {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The number of computing threads.
    pub threads: usize,
    /// What it is there for.
    pub role: Role,
    /// Which figure contains the start of the threads.
    pub threads_start: ThreadsStart,
    /// Whether there is a picture, and every picture was the reference's.
    pub identical: bool,
    /// Of the first picture that was not the reference's, or else of all of them; `None` without any.
    pub digest: Option<Digest>,
    /// Why the strategy failed.
    pub error: Option<String>,
    /// Traced in the warm-up; `None` where nobody counted, or the picture was wrong.
    pub rays: Option<Rays>,
    /// Of the verified renderings, one a round, from the first round on.
    pub samples: Vec<Sample>,
    /// `None` for a row that failed or gave a wrong picture, and for all if the reference did.
    pub figures: Option<Figures>,
}

/// What the samples of a row come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Median time to render, in nanoseconds.
    pub median_ns: f64,
    /// Median time to prepare, in nanoseconds.
    pub prepare_ns: f64,
    /// Time of the reference over the row's own, within a round.
    pub speedup: Interval,
    /// The median speed-up per thread: 1 is perfect.
    pub efficiency: f64,
    /// After Karp and Flatt, from the median speed-up; `None` for one thread.
    pub serial_fraction: Option<f64>,
}

/// Why nothing could be compared.
#[derive(Debug, Error)]
pub enum CompareError {
    /// There is no picture to verify the others with.
    #[error("the reference failed: {0}")]
    Reference(String),
}

impl Comparison {
    /// Whether every row gave the reference's picture, every time.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.rows.iter().all(Row::holds)
    }

    /// What the reference seems to gain on itself: the error of the table.
    #[must_use]
    pub fn control(&self) -> Option<Interval> {
        let control = self.rows.iter().find(|row| row.role == Role::Control)?;
        control.figures.map(|figures| figures.speedup)
    }

    /// How many times as long as here the reference takes in `other`, measured [together](Protocol::run_together)
    /// with this one. `None` unless both have figures.
    #[must_use]
    pub fn gain_over(&self, other: &Self) -> Option<Interval> {
        let times = |comparison: &Self| {
            comparison.rows.first().filter(|row| row.figures.is_some()).map(Row::render_ns)
        };
        ratio_interval(&times(other)?, &times(self)?)
    }
}

impl Row {
    /// Whether it gave the reference's picture, every time.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.identical && self.error.is_none()
    }

    fn new(entry: &Entry<'_>, role: Role) -> Self {
        let threads_start = entry.strategy.threads_start();
        let threads = if threads_start == ThreadsStart::Never { 1 } else { entry.threads.get() };
        Self {
            strategy: entry.strategy.name(),
            threads,
            role,
            threads_start,
            // Until the warm-up has shown otherwise.
            identical: true,
            digest: None,
            error: None,
            rays: None,
            samples: Vec::new(),
            figures: None,
        }
    }

    /// Takes note of a rendering that is no sample.
    fn warm_up(&mut self, result: Result<(Rendering, Option<Rays>), String>, expected: Digest) {
        let rays = result.as_ref().ok().and_then(|(_, rays)| *rays);
        let sample = self.verify(result.map(|(rendering, _)| rendering), expected);
        self.rays = rays.filter(|_| sample.is_some());
    }

    /// Takes note of a rendering that is a sample if its picture is right.
    fn measure(&mut self, result: Result<Rendering, String>, expected: Digest) {
        let sample = self.verify(result, expected);
        self.samples.extend(sample);
    }

    /// Takes note of a rendering's picture, and gives its times if they may be used.
    fn verify(&mut self, result: Result<Rendering, String>, expected: Digest) -> Option<Sample> {
        match result {
            Ok(Rendering { sample, digest }) => {
                self.digest = Some(digest);
                self.identical = digest == expected;
                self.identical.then_some(sample)
            }
            Err(error) => {
                self.error = Some(error);
                self.identical = self.digest.is_some();
                None
            }
        }
    }

    /// The times to render.
    fn render_ns(&self) -> Vec<u64> {
        self.samples.iter().map(|sample| sample.render_ns).collect()
    }

    /// From the times of the reference in the same rounds.
    fn figures(&self, reference_ns: &[u64]) -> Option<Figures> {
        let median_of =
            |of: fn(&Sample) -> u64| median(&self.samples.iter().map(|s| of(s) as f64).collect::<Vec<_>>());
        let speedup = ratio_interval(reference_ns, &self.render_ns())?;
        Some(Figures {
            median_ns: median_of(|sample| sample.render_ns)?,
            prepare_ns: median_of(|sample| sample.prepare_ns)?,
            speedup,
            efficiency: efficiency(speedup.median, self.threads),
            serial_fraction: karp_flatt(speedup.median, self.threads),
        })
    }
}

impl Protocol {
    /// Measures `reference`, its control and `entries`; entries of the reference itself are left
    /// out, since it is measured anyway.
    ///
    /// # Errors
    ///
    /// There is no reference picture.
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

    /// A comparison for each executor, as by [`Protocol::run`] but measured in the same rounds. Each renders a work
    /// of its own, and all have to give the picture that the first gives with `reference`.
    ///
    /// # Errors
    ///
    /// There is no reference picture.
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
        let roles = || [Role::Reference, Role::Control].into_iter().chain(std::iter::repeat(Role::Contender));
        let new_rows = || entries.iter().zip(roles()).map(|(entry, role)| Row::new(entry, role)).collect();

        let digest = first.render(&base).map_err(CompareError::Reference)?.digest;
        let mut tables: Vec<Vec<Row>> = executors.iter().map(|_| new_rows()).collect();
        let mut schedule = self.schedule(tables.len() * entries.len());
        let mut running = vec![true; tables.len()];
        while let Some(turn) = schedule.next(executors[0].elapsed()) {
            // Without its reference a round says nothing.
            if turn.first {
                running = tables.iter().map(|rows| rows[0].holds()).collect();
            }
            if !running.contains(&true) {
                break;
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
            match turn.round {
                None => row.warm_up(executors[table].warm_up(entry), digest),
                Some(_) => row.measure(executors[table].render(entry), digest),
            }
        }

        let (rounds, seed) = (schedule.rounds(), self.seed);
        let comparison = |rows| Comparison { rows: with_figures(rows), digest, rounds, seed };
        Ok(tables.into_iter().map(comparison).collect())
    }
}

fn with_figures(mut rows: Vec<Row>) -> Vec<Row> {
    if rows[0].holds() {
        let reference = rows[0].render_ns();
        for row in rows.iter_mut().filter(|row| row.holds()) {
            row.figures = row.figures(&reference);
        }
    }
    rows
}
