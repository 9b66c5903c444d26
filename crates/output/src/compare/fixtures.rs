//! A made-up list for tests: a reference, its control, a pool, a queue that rendered a wrong image,
//! and a strategy whose threads could not be started.

use super::*;
use rayweave_contract::Image;

pub(super) fn digest(brightness: f32) -> Digest {
    Image::filled(1, 1, [brightness; 3]).expect("a pixel").digest()
}

pub(super) fn around(median: f64) -> Interval {
    Interval { median, low: median - 0.04, high: median + 0.06 }
}

/// Returns a row of two rounds. The cold rendering takes a quarter more time, two threads compute
/// nearly all of the time, and each of 500 x 400 pixels takes 4.38 rays where 4 would be enough.
pub(crate) fn row(strategy: &str, threads: usize, starts_threads: &str, ns: u64) -> Measurement {
    let speedup = 2e9 / ns as f64;
    Measurement {
        strategy: strategy.to_owned(),
        threads,
        control: false,
        granularity: "tile".to_owned(),
        scheduling: "dynamic".to_owned(),
        output: "in-place".to_owned(),
        starts_threads: starts_threads.to_owned(),
        identical: true,
        digest: Some(digest(1.0)),
        error: None,
        median_ns: Some(ns),
        speedup: Some(around(speedup)),
        efficiency: Some(speedup / threads as f64),
        serial_fraction: (threads > 1).then_some(0.0256),
        prepare_ns: Some(84_600),
        cold_ns: Some(ns / 4 * 5),
        cold_speedup: Some(around(1.6e9 / ns as f64)),
        cpu_ns: Some(ns / 10 * 19),
        primary_rays: Some(876_000),
        redundant_rays: Some(76_000),
        primary_packets: Some(113_000),
        samples_ns: vec![ns; 2],
        prepare_samples_ns: vec![84_600; 2],
        cold_samples_ns: vec![ns / 4 * 5; 2],
        cpu_samples_ns: vec![ns / 10 * 19; 2],
    }
}

/// Returns the row without the figures that follow from its samples.
fn without_figures(row: Measurement) -> Measurement {
    Measurement {
        median_ns: None,
        speedup: None,
        efficiency: None,
        serial_fraction: None,
        prepare_ns: None,
        cold_ns: None,
        cold_speedup: None,
        cpu_ns: None,
        ..row
    }
}

/// Returns the row after its threads failed in the third round.
pub(super) fn failed(row: Measurement, error: &str) -> Measurement {
    Measurement { error: Some(error.to_owned()), ..without_figures(row) }
}

pub(super) fn records() -> Vec<Record> {
    let wrong = Measurement {
        identical: false,
        digest: Some(digest(0.5)),
        ..without_figures(row("queue", 2, "per-render", 1_000_000_000))
    };
    let many = row("many, \"too\" many", 9000, "per-render", 1);
    let many = Measurement {
        identical: false,
        digest: None,
        primary_rays: None,
        redundant_rays: None,
        primary_packets: None,
        samples_ns: Vec::new(),
        prepare_samples_ns: Vec::new(),
        cold_samples_ns: Vec::new(),
        cpu_samples_ns: Vec::new(),
        ..failed(many, "cannot start 9000 threads")
    };
    let control = row("sequential", 1, "none", 2_010_000_000);
    let rows = [
        row("sequential", 1, "none", 2_000_000_000),
        Measurement { control: true, ..control },
        row("pool", 2, "pool", 1_025_641_026),
        wrong,
        many,
    ];
    rows.map(record).into()
}

pub(super) fn record(measurement: Measurement) -> Record {
    Record {
        subject: subject(),
        rounds: 2,
        interrupted: false,
        disturbed: false,
        reference_digest: digest(1.0).to_string(),
        imbalance: None,
        largest_tile: None,
        measurement,
    }
}

pub(super) fn results() -> Results {
    let mut results = Results::new(machine(), noise(), records());
    results.seed = 1;
    results
}

pub(super) fn subject() -> Subject {
    Subject {
        scene: "room".to_owned(),
        width: 500,
        height: 400,
        antialiasing: 2,
        sampling: "lattice".to_owned(),
        adaptive: false,
        formulas: "robust".to_owned(),
        precision: "f32".to_owned(),
        lanes: 8,
        share_samples: true,
        accel: "auto".to_owned(),
        tile: 32,
    }
}

pub(crate) fn machine() -> Machine {
    Machine {
        cpu: "A CPU".to_owned(),
        logical_cores: 8,
        available_threads: 2,
        quota_cores: Some(1.5),
        os: "linux".to_owned(),
        arch: "x86_64".to_owned(),
        target_features: vec!["sse2".to_owned()],
        compiler: "rustc 1.0".to_owned(),
        profile: "release".to_owned(),
        commit: "0123456789ab".to_owned(),
    }
}

/// Returns the noise of ten seconds in which others used 1 % of the machine.
pub(crate) fn noise() -> Noise {
    Noise {
        wall_s: 10.0,
        foreign_cpu_s: Some(0.15),
        stolen_s: Some(0.05),
        share_of_others: Some(0.01),
        throttled: Some(0),
        involuntary_switches: Some(34),
        lowest_mhz: Some(2400.0),
        highest_mhz: Some(3600.0),
        disturbed: false,
    }
}
