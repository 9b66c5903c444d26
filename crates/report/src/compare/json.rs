//! The comparison for other programs.

use super::baseline::{self, Baseline, Change};
use super::{BothReport, Report, Subject, search, threads_start};
use crate::json::{self, Ratio};
use crate::machine::Facts;
use crate::noise;
use rayweave_measure::compare::{Role, Row};
use serde::Serialize;

/// It changes when a key changes its meaning or goes.
pub(super) const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Object<'a> {
    schema: u32,
    #[serde(flatten)]
    settings: Settings<'a>,
    rounds: usize,
    interrupted: bool,
    seed: u64,
    digest: String,
    machine: Facts<'a>,
    precision_goal: Option<f64>,
    noise: noise::Object,
    #[serde(skip_serializing_if = "Option::is_none")]
    changes: Option<Vec<baseline::Object>>,
    results: Vec<Result<'a>>,
}

/// What two comparisons have to have in common for their times to be compared.
#[derive(Serialize)]
pub(super) struct Settings<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    antialiasing: u32,
    sampling: String,
    adaptive: bool,
    formulas: String,
    precision: &'a str,
    lanes: usize,
    share_samples: bool,
    search: &'a str,
    tile: u32,
}

impl<'a> From<&'a Subject> for Settings<'a> {
    fn from(subject: &'a Subject) -> Self {
        Self {
            scene: &subject.scene,
            width: subject.width,
            height: subject.height,
            antialiasing: subject.antialiasing,
            sampling: subject.sampling.to_string(),
            adaptive: subject.adaptive,
            formulas: subject.formulas.to_string(),
            precision: &subject.precision,
            lanes: subject.lanes,
            share_samples: subject.share_samples,
            search: search(subject.search),
            tile: subject.tile,
        }
    }
}

/// The object with samples shared, and what else there is to say.
#[derive(Serialize)]
struct Both<'a> {
    #[serde(flatten)]
    shared: Object<'a>,
    sharing_speedup: Option<Ratio>,
    unshared: Object<'a>,
}

#[derive(Serialize)]
struct Result<'a> {
    strategy: &'a str,
    threads: usize,
    control: bool,
    identical: bool,
    digest: Option<String>,
    median_ns: Option<u64>,
    samples_ns: Vec<u64>,
    speedup: Option<Ratio>,
    efficiency: Option<f64>,
    serial_fraction: Option<f64>,
    threads_start: &'a str,
    prepare_ns: Option<u64>,
    prepare_samples_ns: Vec<u64>,
    error: Option<&'a str>,
    primary_rays: Option<u64>,
    redundant_rays: Option<u64>,
    one_shot: Option<OneShot>,
    cpu_ns: Option<u64>,
    cpu_samples_ns: Option<Vec<u64>>,
}

#[derive(Serialize)]
struct OneShot {
    median_ns: u64,
    samples_ns: Vec<u64>,
    speedup: Ratio,
}

pub(super) fn text(report: &Report<'_>) -> String {
    json::text(&object(report))
}

/// Comparisons of several scenes.
#[derive(Serialize)]
struct Several<'a> {
    schema: u32,
    comparisons: Vec<Object<'a>>,
    not_measured: &'a [String],
}

pub(super) fn several(reports: &[Report<'_>], not_measured: &[String]) -> String {
    let comparisons = reports.iter().map(object).collect();
    json::text(&Several { schema: SCHEMA, comparisons, not_measured })
}

pub(super) fn both(report: &BothReport<'_>) -> String {
    json::text(&Both {
        shared: object(&report.shared),
        sharing_speedup: report.gain().map(Ratio::from),
        unshared: object(&report.unshared),
    })
}

fn object<'a>(report: &Report<'a>) -> Object<'a> {
    let Report { subject, comparison, machine, noise, baseline } = *report;
    let changes =
        |baseline: &Baseline| baseline.changes(comparison).iter().map(Change::object).collect();
    Object {
        schema: SCHEMA,
        settings: subject.into(),
        rounds: comparison.rounds,
        interrupted: comparison.interrupted,
        seed: comparison.seed,
        digest: comparison.digest.to_string(),
        machine: Facts::new(machine),
        precision_goal: comparison.goal,
        noise: noise.into(),
        changes: baseline.map(changes),
        results: comparison.rows.iter().map(result).collect(),
    }
}

fn result(row: &Row) -> Result<'_> {
    let figures = row.figures.as_ref();
    Result {
        strategy: row.strategy,
        threads: row.threads,
        control: row.role == Role::Control,
        identical: row.identical,
        digest: row.digest.map(|digest| digest.to_string()),
        median_ns: figures.map(|figures| figures.median_ns.round() as u64),
        samples_ns: row.samples.iter().map(|sample| sample.render_ns).collect(),
        speedup: figures.map(|figures| figures.speedup.into()),
        efficiency: figures.map(|figures| figures.efficiency),
        serial_fraction: figures.and_then(|figures| figures.serial_fraction),
        threads_start: threads_start(row),
        prepare_ns: figures.map(|figures| figures.prepare_ns.round() as u64),
        prepare_samples_ns: row.samples.iter().map(|sample| sample.prepare_ns).collect(),
        error: row.error.as_deref(),
        primary_rays: row.rays.map(|rays| rays.primary),
        redundant_rays: row.rays.map(|rays| rays.redundant),
        one_shot: one_shot(row),
        cpu_ns: figures.and_then(|figures| figures.cpu_ns).map(|ns| ns.round() as u64),
        cpu_samples_ns: row.samples.iter().map(|sample| sample.cpu_ns).collect(),
    }
}

fn one_shot(row: &Row) -> Option<OneShot> {
    let one_shot = row.figures.as_ref()?.one_shot?;
    Some(OneShot {
        median_ns: one_shot.median_ns.round() as u64,
        samples_ns: row.samples.iter().filter_map(|sample| sample.one_shot_ns).collect(),
        speedup: one_shot.speedup.into(),
    })
}
