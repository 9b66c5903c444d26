//! The explanation for other programs.

use super::{Report, Thread, imbalance};
use crate::json;
use rayweave_measure::efficiency::{Cause, LostTime};
use rayweave_measure::explanation::ExplainedStrategy;
use rayweave_measure::{Interval, Machine, Noise};
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
    strategy: &'a str,
    threads: usize,
    wall_ns: f64,
    speedup: f64,
    lost_ns: f64,
    losses_ns: Causes,
    unexplained_ns: f64,
    recorded_over_plain: Interval,
    imbalance: f64,
    long_gap_ns: f64,
    threads_recorded: Vec<Thread<'a>>,
}

#[derive(Serialize)]
struct Causes {
    redundant: f64,
    slowdown: f64,
    dispatch: f64,
    contention: f64,
    imbalance: f64,
    serial: f64,
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
        strategy: row.strategy,
        threads: row.threads,
        wall_ns: row.wall_ns,
        speedup: report.explanation.reference_ns / row.wall_ns,
        lost_ns: row.lost_ns,
        losses_ns: causes(&row.lost_time),
        unexplained_ns: row.unexplained_ns(),
        recorded_over_plain: row.recorded,
        imbalance: imbalance(row),
        long_gap_ns: row.long_gap_ns,
        threads_recorded: Thread::all(row, report.rays),
    }
}

fn causes(losses: &LostTime) -> Causes {
    Causes {
        redundant: losses.to(Cause::Redundant),
        slowdown: losses.to(Cause::Slowdown),
        dispatch: losses.to(Cause::Dispatch),
        contention: losses.to(Cause::Contention),
        imbalance: losses.to(Cause::Imbalance),
        serial: losses.to(Cause::Serial),
    }
}
