//! A row of the table: its samples, and what they come to.

use super::{Entry, Rays, Rendering, Sample};
use crate::statistics::{Interval, efficiency, karp_flatt, median, ratio_interval};
use rayweave_contract::{Digest, Policy, Threads};

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

/// What the first renderings of fresh processes come to, preparing included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneShot {
    /// Median time, in nanoseconds.
    pub median_ns: f64,
    /// Time of the reference's over the row's own, within a round.
    pub speedup: Interval,
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
    pub threads_start: Threads,
    /// How it deals out the work.
    pub policy: Policy,
    /// Whether there is a picture, and every picture was the reference's.
    pub identical: bool,
    /// Of the first picture that was not the reference's, or else of all of them; `None` without
    /// any.
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
    /// The first renderings, where each sample has one.
    pub one_shot: Option<OneShot>,
    /// Median CPU time of all threads together while rendering, in nanoseconds, where it is known.
    pub cpu_ns: Option<f64>,
    /// Time of the reference over the row's own, within a round.
    pub speedup: Interval,
    /// The median speed-up per thread: 1 is perfect.
    pub efficiency: f64,
    /// After Karp and Flatt, from the median speed-up; `None` for one thread.
    pub serial_fraction: Option<f64>,
}

impl Row {
    /// Whether it gave the reference's picture, every time.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.identical && self.error.is_none()
    }

    pub(super) fn new(entry: &Entry<'_>, role: Role) -> Self {
        let threads_start = entry.strategy.threads();
        let threads = threads_start.computing_threads(entry.threads).get();
        Self {
            strategy: entry.strategy.name(),
            threads,
            role,
            threads_start,
            policy: entry.strategy.policy(),
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
    pub(super) fn warm_up(
        &mut self,
        result: Result<(Rendering, Option<Rays>), String>,
        expected: Digest,
    ) {
        let rays = result.as_ref().ok().and_then(|(_, rays)| *rays);
        let sample = self.verify(result.map(|(rendering, _)| rendering), expected);
        self.rays = rays.filter(|_| sample.is_some());
    }

    /// Takes note of a rendering that is a sample if its picture is right.
    pub(super) fn measure(&mut self, result: Result<Rendering, String>, expected: Digest) {
        let sample = self.verify(result, expected);
        self.samples.extend(sample);
    }

    /// Takes note of a rendering's picture, and gives its times if they may be used.
    fn verify(&mut self, result: Result<Rendering, String>, expected: Digest) -> Option<Sample> {
        match result {
            Ok(Rendering { sample, digest, first_digest }) => {
                // Of two pictures the wrong one, if one is.
                let digest = first_digest.filter(|&first| first != expected).unwrap_or(digest);
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

    /// The times to render, in nanoseconds, one a round.
    #[must_use]
    pub fn render_ns(&self) -> Vec<u64> {
        self.samples.iter().map(|sample| sample.render_ns).collect()
    }

    /// Whether the interval of its speed-up is narrow enough, or it will have none.
    pub(super) fn is_precise(&self, reference: &Self, goal: f64) -> bool {
        let speedup = || ratio_interval(&reference.render_ns(), &self.render_ns());
        !self.holds() || speedup().is_some_and(|speedup| speedup.relative_half_width() <= goal)
    }

    /// From the reference's samples in the same rounds.
    fn figures(&self, reference: &Self) -> Option<Figures> {
        let speedup = ratio_interval(&reference.render_ns(), &self.render_ns())?;
        Some(Figures {
            median_ns: self.median_of(|sample| Some(sample.render_ns))?,
            prepare_ns: self.median_of(|sample| Some(sample.prepare_ns))?,
            one_shot: self.one_shot(reference),
            cpu_ns: self.median_of(|sample| sample.cpu_ns),
            speedup,
            efficiency: efficiency(speedup.median, self.threads),
            serial_fraction: karp_flatt(speedup.median, self.threads),
        })
    }

    fn one_shot(&self, reference: &Self) -> Option<OneShot> {
        let one_shot = |sample: &Sample| sample.one_shot_ns;
        let speedup = ratio_interval(&reference.all(one_shot)?, &self.all(one_shot)?)?;
        Some(OneShot { median_ns: self.median_of(one_shot)?, speedup })
    }

    /// What every sample has, if every one does.
    fn all(&self, of: impl Fn(&Sample) -> Option<u64>) -> Option<Vec<u64>> {
        self.samples.iter().map(of).collect()
    }

    fn median_of(&self, of: impl Fn(&Sample) -> Option<u64>) -> Option<f64> {
        let values: Vec<f64> = self.all(of)?.into_iter().map(|value| value as f64).collect();
        median(&values)
    }
}

/// Gives the rows, of which the reference is the first, their figures.
pub(super) fn with_figures(mut rows: Vec<Row>) -> Vec<Row> {
    let Some(reference) = rows.first().filter(|reference| reference.holds()).cloned() else {
        return rows;
    };
    for row in rows.iter_mut().filter(|row| row.holds()) {
        row.figures = row.figures(&reference);
    }
    rows
}
