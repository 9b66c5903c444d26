//! The time breakdown as JSON.

use super::{ExplanationView, Thread, imbalance};
use crate::json;
use rayweave_measure::explanation::ExplainedStrategy;
use rayweave_measure::{Machine, Noise};
use serde::Serialize;

/// The schema number of the JSON. It changes when a key is removed or changes its meaning.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct ExplanationDocument<'a> {
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
    results: Vec<ExplanationEntry<'a>>,
}

#[derive(Serialize)]
struct ExplanationEntry<'a> {
    #[serde(flatten)]
    row: &'a ExplainedStrategy,
    speedup: f64,
    unexplained_ns: f64,
    imbalance: f64,
    threads_recorded: Vec<Thread<'a>>,
}

pub(super) fn text(view: &ExplanationView<'_>) -> String {
    let ExplanationView { scene, size: (width, height), tile, explanation, machine, noise, .. } =
        *view;
    json::text(&ExplanationDocument {
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
        results: explanation.rows.iter().map(|row| entry(view, row)).collect(),
    })
}

fn entry<'a>(view: &ExplanationView<'a>, row: &'a ExplainedStrategy) -> ExplanationEntry<'a> {
    ExplanationEntry {
        row,
        speedup: view.explanation.reference_ns / row.wall_ns,
        unexplained_ns: row.unexplained_ns(),
        imbalance: imbalance(row),
        threads_recorded: Thread::all(row, view.rays),
    }
}
