//! The comparison for spreadsheets: every line stands for itself.

use super::{BothReport, Report, search, threads_start};
use crate::csv;
use rayweave_measure::compare::{Role, Row};
use serde::Serialize;

#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    antialiasing: u32,
    sampling: String,
    formulas: String,
    precision: &'a str,
    tile: u32,
    strategy: &'a str,
    threads: usize,
    control: bool,
    identical: bool,
    digest: Option<String>,
    samples: usize,
    median_ns: Option<u64>,
    speedup: Option<f64>,
    speedup_low: Option<f64>,
    speedup_high: Option<f64>,
    efficiency: Option<f64>,
    serial_fraction: Option<f64>,
    threads_start: &'a str,
    prepare_ns: Option<u64>,
    error: Option<&'a str>,
    cpu: &'a str,
    available_threads: usize,
    compiler: &'a str,
    profile: &'a str,
    commit: &'a str,
    lanes: usize,
    share_samples: bool,
    search: &'a str,
    primary_rays: Option<u64>,
    redundant_rays: Option<u64>,
    adaptive: bool,
    one_shot_ns: Option<u64>,
    one_shot_speedup: Option<f64>,
    one_shot_speedup_low: Option<f64>,
    one_shot_speedup_high: Option<f64>,
    cpu_ns: Option<u64>,
    disturbed: bool,
    interrupted: bool,
}

pub(super) fn text(report: &Report<'_>) -> String {
    csv::text(lines(report))
}

pub(super) fn both(BothReport { shared, unshared }: &BothReport<'_>) -> String {
    csv::text(lines(shared).chain(lines(unshared)))
}

pub(super) fn several(reports: &[Report<'_>]) -> String {
    csv::text(reports.iter().flat_map(lines))
}

fn lines<'a>(report: &Report<'a>) -> impl Iterator<Item = Line<'a>> {
    report.comparison.rows.iter().map(|row| line(report, row))
}

fn line<'a>(report: &Report<'a>, row: &'a Row) -> Line<'a> {
    let Report { subject, comparison, machine, noise, .. } = report;
    let figures = row.figures.as_ref();
    let speedup = figures.map(|figures| figures.speedup);
    let one_shot = figures.and_then(|figures| figures.one_shot);
    Line {
        scene: &subject.scene,
        width: subject.width,
        height: subject.height,
        antialiasing: subject.antialiasing,
        sampling: subject.sampling.to_string(),
        formulas: subject.formulas.to_string(),
        precision: &subject.precision,
        tile: subject.tile,
        strategy: row.strategy,
        threads: row.threads,
        control: row.role == Role::Control,
        identical: row.identical,
        digest: row.digest.map(|digest| digest.to_string()),
        samples: row.samples.len(),
        median_ns: figures.map(|figures| figures.median_ns.round() as u64),
        speedup: speedup.map(|interval| interval.median),
        speedup_low: speedup.map(|interval| interval.low),
        speedup_high: speedup.map(|interval| interval.high),
        efficiency: figures.map(|figures| figures.efficiency),
        serial_fraction: figures.and_then(|figures| figures.serial_fraction),
        threads_start: threads_start(row),
        prepare_ns: figures.map(|figures| figures.prepare_ns.round() as u64),
        error: row.error.as_deref(),
        cpu: &machine.cpu,
        available_threads: machine.available_threads,
        compiler: machine.compiler,
        profile: machine.profile,
        commit: machine.commit,
        lanes: subject.lanes,
        share_samples: subject.share_samples,
        search: search(subject.search),
        primary_rays: row.rays.map(|rays| rays.primary),
        redundant_rays: row.rays.map(|rays| rays.redundant),
        adaptive: subject.adaptive,
        one_shot_ns: one_shot.map(|one_shot| one_shot.median_ns.round() as u64),
        one_shot_speedup: one_shot.map(|one_shot| one_shot.speedup.median),
        one_shot_speedup_low: one_shot.map(|one_shot| one_shot.speedup.low),
        one_shot_speedup_high: one_shot.map(|one_shot| one_shot.speedup.high),
        cpu_ns: figures.and_then(|figures| figures.cpu_ns).map(|ns| ns.round() as u64),
        disturbed: noise.is_disturbing(),
        interrupted: comparison.interrupted,
    }
}
