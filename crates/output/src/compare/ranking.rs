//! The comparison of rows: which are fastest, and which cannot be told apart.

use super::{Record, control};
use rayweave_contract::Scheduling;
use rayweave_measure::Interval;
use rayweave_measure::statistics::ratio_interval_of_level;

/// The chance of taking any of several rows for slower that is not.
const ERROR: f64 = 0.05;

/// The largest error of a control with which figures can be relied on.
pub(super) const LARGEST_ERROR: f64 = 0.1;

/// The strategies of a subject with one number of threads, without reference and control.
#[derive(Clone, Debug)]
pub(super) struct Section<'a> {
    /// The number of threads.
    pub(super) threads: usize,
    /// The rows with figures, the fastest first.
    pub(super) rows: Vec<&'a Record>,
    /// The rows without figures.
    pub(super) failed: Vec<&'a Record>,
    /// The smallest difference between two rows that counts, as a share: the control's error.
    pub(super) control_error: f64,
}

impl<'a> Section<'a> {
    /// Returns the sections of a subject's records by their number of threads, in the order given.
    pub(super) fn all(group: &'a [Record]) -> Vec<Self> {
        let control_error = control(group).map_or(0.0, distance_from_1);
        let mut sections: Vec<Self> = Vec::new();
        for record in group.iter().skip(1).filter(|record| !record.measurement.control) {
            let threads = record.measurement.threads;
            let known = sections.iter().position(|section| section.threads == threads);
            let place = known.unwrap_or(sections.len());
            if known.is_none() {
                let (rows, failed) = (Vec::new(), Vec::new());
                sections.push(Self { threads, rows, failed, control_error });
            }
            let section = &mut sections[place];
            let has_figures = record.measurement.speedup.is_some();
            if has_figures { &mut section.rows } else { &mut section.failed }.push(record);
        }
        for section in &mut sections {
            section.rows.sort_by(|a, b| speedup(b).total_cmp(&speedup(a)));
        }
        sections
    }

    /// Returns the fastest row, those that cannot be told apart from it, and the slower ones, each
    /// with its time over the fastest row's.
    pub(super) fn ranked(&self) -> (Vec<&'a Record>, Vec<(&'a Record, Interval)>) {
        rank(&self.rows, self.control_error)
    }

    /// Returns the time of `row` over that of `than` in the same rounds, if it is longer: its
    /// interval lies above 1, and its median further than the control's error.
    pub(super) fn slower(&self, row: &Record, than: &Record) -> Option<Interval> {
        self.longer(&row.measurement.samples_ns, &than.measurement.samples_ns)
    }

    /// Returns the ratio of two times in the same rounds, if the first is longer.
    pub(super) fn longer(&self, time: &[u64], than: &[u64]) -> Option<Interval> {
        longer(time, than, self.control_error, 1)
    }

    /// Returns whether the figures are precise enough to rely on.
    pub(super) fn is_certain(&self) -> bool {
        self.control_error <= LARGEST_ERROR
    }

    /// Returns whether any row is faster than one thread.
    pub(super) fn pays_off(&self) -> bool {
        let mut speedups = self.rows.iter().filter_map(|record| record.measurement.speedup);
        speedups.any(|it| it.low > 1.0 && it.median > 1.0 + self.control_error)
    }
}

/// Splits `rows`, the fastest first, into those like the first and the slower ones.
pub(super) fn rank<'a>(
    rows: &[&'a Record],
    control_error: f64,
) -> (Vec<&'a Record>, Vec<(&'a Record, Interval)>) {
    let (mut alike, mut behind) = (Vec::new(), Vec::new());
    for &row in rows {
        let [time, than] = [row, rows[0]].map(|row| &*row.measurement.samples_ns);
        match longer(time, than, control_error, rows.len() - 1) {
            Some(ratio) => behind.push((row, ratio)),
            None => alike.push(row),
        }
    }
    (alike, behind)
}

/// Returns the ratio of two times, if the first is longer. It is one of several `comparisons`,
/// which share the chance of an error (Bonferroni).
fn longer(time: &[u64], than: &[u64], control_error: f64, comparisons: usize) -> Option<Interval> {
    let level = 1.0 - ERROR / comparisons.max(1) as f64;
    let ratio = ratio_interval_of_level(time, than, level)?;
    (ratio.low > 1.0 && ratio.median > 1.0 + control_error).then_some(ratio)
}

/// Returns the median speed-up of a row with figures.
pub(super) fn speedup(record: &Record) -> f64 {
    record.measurement.speedup.map_or(0.0, |speedup| speedup.median)
}

/// Returns whether equal shares are fixed beforehand.
pub(super) fn is_static(record: &Record) -> bool {
    record.measurement.scheduling == Scheduling::Static.to_string()
}

/// Returns the distance from 1 that the interval reaches.
pub(super) fn distance_from_1(interval: Interval) -> f64 {
    (interval.high - 1.0).max(1.0 - interval.low)
}

/// Returns a share in whole percent, rounded up: a limit that the share does not exceed.
pub(super) fn percent_up(share: f64) -> String {
    // A share that is a whole number but for its last bits is not rounded up.
    format!("{:.0} %", (share * 100.0 - 1e-9).ceil().max(1.0))
}
