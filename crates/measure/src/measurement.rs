//! The measurement of one strategy with one number of threads. Tables, files and pages are views of
//! a list of measurements.

use crate::digest_text;
use crate::statistics::{Interval, LEAST_VALUES, efficiency, karp_flatt, median, ratio_interval};
use rayweave_contract::{Digest, Policy, Strategy, Threads};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;

/// One rendering in a process: its times and the digests of its images. A child process answers
/// with this.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sample {
    /// Time to prepare the strategy, in nanoseconds.
    pub prepare_ns: u64,
    /// Time to render, in nanoseconds; the second rendering where there is a cold one.
    pub render_ns: u64,
    /// Time to prepare the strategy and to render the first image of a fresh process, in
    /// nanoseconds. `None` where the process is not fresh.
    pub cold_ns: Option<u64>,
    /// CPU time of all threads together while rendering, in nanoseconds, where the system tells.
    pub cpu_ns: Option<u64>,
    /// The digest of the image.
    #[serde(with = "digest_text")]
    pub digest: Digest,
    /// The digest of the cold image, where there is one.
    #[serde(with = "digest_text::optional")]
    pub cold_digest: Option<Digest>,
    /// The primary rays traced, where they were counted.
    pub primary_rays: Option<u64>,
    /// The primary rays that one tile of the whole image would not have traced, where they were
    /// counted: neighbouring tiles each trace the samples that they could share.
    pub redundant_rays: Option<u64>,
    /// The packets of primary rays traced, where they were counted.
    pub primary_packets: Option<u64>,
}

impl Sample {
    /// Returns a sample with these three values and nothing else.
    #[must_use]
    pub fn new(prepare_ns: u64, render_ns: u64, digest: Digest) -> Self {
        Self {
            prepare_ns,
            render_ns,
            cold_ns: None,
            cpu_ns: None,
            digest,
            cold_digest: None,
            primary_rays: None,
            redundant_rays: None,
            primary_packets: None,
        }
    }
}

/// The measurement of a strategy with a number of threads. Each list of samples has one value a
/// round, of verified renderings only, or is empty if the value is unknown. A figure is `None` if
/// the strategy failed or gave another image, and for all strategies if the reference did.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// The strategy's name.
    pub strategy: String,
    /// The number of computing threads.
    pub threads: usize,
    /// True if it is the reference measured a second time.
    #[serde(default)]
    pub control: bool,
    /// The [granularity](rayweave_contract::Granularity) of the strategy's pieces, in a word.
    #[serde(default)]
    pub granularity: String,
    /// The [scheduling](rayweave_contract::Scheduling) of the pieces, as OpenMP writes it.
    #[serde(default)]
    pub scheduling: String,
    /// The way of finished pieces to the [image](rayweave_contract::Output), in a word.
    #[serde(default)]
    pub output: String,
    /// The place where the strategy [starts its threads](rayweave_contract::Threads), in a word.
    #[serde(default)]
    pub starts_threads: String,
    /// True if there is an image, and every image was the reference's.
    pub identical: bool,
    /// The digest of the first image that was not the reference's, or else of all images; `None`
    /// without any.
    #[serde(with = "digest_text::optional")]
    pub digest: Option<Digest>,
    /// The reason why the strategy failed; it is then measured no further.
    pub error: Option<String>,
    /// The median time to render, in nanoseconds.
    pub median_ns: Option<u64>,
    /// The reference's time over this one's within a round.
    pub speedup: Option<Interval>,
    /// The median speed-up divided by the number of threads: 1 is perfect.
    pub efficiency: Option<f64>,
    /// The serial fraction after Karp and Flatt, from the median speed-up; `None` for one thread.
    pub serial_fraction: Option<f64>,
    /// The median time to prepare the strategy, in nanoseconds.
    pub prepare_ns: Option<u64>,
    /// The median time to prepare and to render the first image of a fresh process, in nanoseconds.
    pub cold_ns: Option<u64>,
    /// The reference's cold time over this one's within a round.
    pub cold_speedup: Option<Interval>,
    /// The median CPU time of all threads together while rendering, in nanoseconds.
    pub cpu_ns: Option<u64>,
    /// The primary rays traced in the warm-up; `None` if they were not counted.
    pub primary_rays: Option<u64>,
    /// The primary rays that one tile of the whole image would not have traced.
    pub redundant_rays: Option<u64>,
    /// The packets of primary rays traced in the warm-up.
    pub primary_packets: Option<u64>,
    /// The times to render, in nanoseconds.
    pub samples_ns: Vec<u64>,
    /// The times to prepare the strategy, in nanoseconds.
    #[serde(default)]
    pub prepare_samples_ns: Vec<u64>,
    /// The cold times, in nanoseconds.
    #[serde(default)]
    pub cold_samples_ns: Vec<u64>,
    /// The CPU times, in nanoseconds.
    #[serde(default)]
    pub cpu_samples_ns: Vec<u64>,
}

impl Measurement {
    /// Returns a measurement of `strategy` without a sample yet, for which `threads` were asked.
    #[must_use]
    pub fn new(strategy: Strategy<'_>, threads: NonZeroUsize, control: bool) -> Self {
        let starts_threads: Threads = strategy.threads;
        let Policy { granularity, scheduling, output } = strategy.policy;
        Self {
            strategy: strategy.name.to_owned(),
            threads: starts_threads.computing_threads(threads).get(),
            control,
            granularity: granularity.to_string(),
            scheduling: scheduling.to_string(),
            output: output.to_string(),
            starts_threads: starts_threads.to_string(),
            // Until the warm-up has shown otherwise.
            identical: true,
            ..Self::default()
        }
    }

    /// Returns whether the strategy gave the reference's image, every time.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.identical && self.error.is_none()
    }

    /// Records the rendering of the warm-up: its image and its rays, not its times.
    pub(crate) fn warm_up(&mut self, result: Result<Sample, String>, expected: Digest) {
        if let Some(sample) = self.verify(result, expected) {
            (self.primary_rays, self.redundant_rays) = (sample.primary_rays, sample.redundant_rays);
            self.primary_packets = sample.primary_packets;
        }
    }

    /// Records a rendering of a round: its times only if its image is right.
    pub(crate) fn add(&mut self, result: Result<Sample, String>, expected: Digest) {
        if let Some(sample) = self.verify(result, expected) {
            self.samples_ns.push(sample.render_ns);
            self.prepare_samples_ns.push(sample.prepare_ns);
            self.cold_samples_ns.extend(sample.cold_ns);
            self.cpu_samples_ns.extend(sample.cpu_ns);
        }
    }

    /// Forgets the samples after the first `rounds`.
    pub(crate) fn truncate(&mut self, rounds: usize) {
        self.samples_ns.truncate(rounds);
        self.prepare_samples_ns.truncate(rounds);
        self.cold_samples_ns.truncate(rounds);
        self.cpu_samples_ns.truncate(rounds);
    }

    /// Records the digest or the error; returns the sample if its times count.
    fn verify(&mut self, result: Result<Sample, String>, expected: Digest) -> Option<Sample> {
        match result {
            Ok(sample) => {
                // If one of two images is wrong, its digest is the one to report.
                let wrong = sample.cold_digest.filter(|&cold| cold != expected);
                let digest = wrong.unwrap_or(sample.digest);
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

    /// Returns whether the speed-up's interval is narrow enough, or there will be none.
    pub(crate) fn is_precise(&self, reference: &Self, goal: f64) -> bool {
        let speedup = || ratio_interval(&reference.samples_ns, &self.samples_ns);
        !self.passed() || speedup().is_some_and(|speedup| speedup.relative_half_width() <= goal)
    }

    /// Computes all figures from the samples and those of the reference in the same rounds.
    fn compute_figures(&mut self, reference: &Self) {
        let Some(speedup) = ratio_interval(&reference.samples_ns, &self.samples_ns) else { return };
        self.median_ns = self.median_of(&self.samples_ns);
        self.speedup = Some(speedup);
        self.efficiency = Some(efficiency(speedup.median, self.threads));
        self.serial_fraction = karp_flatt(speedup.median, self.threads);
        self.prepare_ns = self.median_of(&self.prepare_samples_ns);
        self.cpu_ns = self.median_of(&self.cpu_samples_ns);
        self.cold_ns = self.median_of(&self.cold_samples_ns);
        let cold = self.cold_ns.and(reference.median_of(&reference.cold_samples_ns));
        self.cold_speedup =
            cold.and_then(|_| ratio_interval(&reference.cold_samples_ns, &self.cold_samples_ns));
    }

    /// Returns the median of one of the lists, rounded to a nanosecond, if every round has a value.
    fn median_of(&self, samples: &[u64]) -> Option<u64> {
        let values: Vec<f64> = samples.iter().map(|&value| value as f64).collect();
        let complete = values.len() == self.samples_ns.len();
        median(&values).filter(|_| complete).map(|median| median.round() as u64)
    }
}

/// Computes the figures of all `rows`, the first of which is the reference.
pub(crate) fn compute_figures(rows: &mut [Measurement]) {
    let Some(reference) = rows.first().filter(|reference| reference.identical).cloned() else {
        return;
    };
    // If the reference's process was killed after many rounds, these still count.
    let complete = reference.samples_ns.len();
    if reference.error.is_some() {
        if complete < LEAST_VALUES {
            return;
        }
        rows.iter_mut().for_each(|row| row.truncate(complete));
    }
    for row in rows.iter_mut().filter(|row| row.passed()) {
        row.compute_figures(&reference);
    }
}
