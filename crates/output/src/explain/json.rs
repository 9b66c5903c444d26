//! The explanation for other programs.

use super::{Report, Thread, imbalance};
use crate::json;
use rayweave_measure::explanation::ExplainedStrategy;
use rayweave_measure::{Machine, Noise};
use serde::Serialize;

/// It changes when a key changes its meaning or goes.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Object<'a> {
    schema: u32,
    scene: &'a str,
    width: u32,
    height: u32,
    tile: u32,
    digest: String,
    rounds: usize,
    reference: &'a str,
    reference_ns: f64,
    recording_inside_ns: f64,
    recording_between_ns: f64,
    machine: &'a Machine,
    noise: &'a Noise,
    results: Vec<Entry<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    row: &'a ExplainedStrategy,
    speedup: f64,
    unexplained_ns: f64,
    imbalance: f64,
    threads_recorded: Vec<Thread<'a>>,
}

pub(super) fn text(report: &Report<'_>) -> String {
    let Report { scene, size: (width, height), tile, explanation, machine, noise, .. } = *report;
    json::text(&Object {
        schema: SCHEMA,
        scene,
        width,
        height,
        tile,
        digest: explanation.digest.to_string(),
        rounds: explanation.rounds,
        reference: explanation.reference,
        reference_ns: explanation.reference_ns,
        recording_inside_ns: explanation.cost.inside_ns,
        recording_between_ns: explanation.cost.outside_ns,
        machine,
        noise,
        results: explanation.rows.iter().map(|row| entry(report, row)).collect(),
    })
}

fn entry<'a>(report: &Report<'a>, row: &'a ExplainedStrategy) -> Entry<'a> {
    Entry {
        row,
        speedup: report.explanation.reference_ns / row.wall_ns,
        unexplained_ns: row.unexplained_ns(),
        imbalance: imbalance(row),
        threads_recorded: Thread::all(row, report.rays),
    }
}
