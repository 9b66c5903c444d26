//! The predictions as JSON.

use super::{ASSUMPTIONS, ForecastView};
use crate::json;
use rayweave_measure::forecast::{ForecastCurve, ForecastPoint, Slowdown};
use rayweave_measure::{Machine, Noise};
use rayweave_predict::{Law, Overheads};
use serde::Serialize;

/// The schema number of the JSON. It changes when a key is removed or changes its meaning.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct ForecastDocument<'a> {
    schema: u32,
    scene: &'a str,
    width: u32,
    height: u32,
    tile: u32,
    rounds: usize,
    digest: String,
    machine: &'a Machine,
    noise: &'a Noise,
    assumptions: [&'a str; 5],
    slowdowns: &'a [Slowdown],
    reference_median_ns: Option<f64>,
    results: Vec<ForecastEntry<'a>>,
    laws: Vec<LawsEntry<'a>>,
    unavailable: &'a [String],
}

#[derive(Serialize)]
struct ForecastEntry<'a> {
    strategy: &'a str,
    #[serde(flatten)]
    point: &'a ForecastPoint,
    difference: Option<f64>,
}

#[derive(Serialize)]
struct LawsEntry<'a> {
    strategy: &'a str,
    amdahl: Option<AmdahlLaw>,
    usl: Option<UslLaw>,
    overheads: OverheadsEntry,
}

#[derive(Serialize)]
struct AmdahlLaw {
    serial: f64,
    error: f64,
}

#[derive(Serialize)]
struct UslLaw {
    sigma: f64,
    kappa: f64,
    error: f64,
    /// Null where more threads are always faster.
    peak: Option<f64>,
}

#[derive(Serialize)]
struct OverheadsEntry {
    start_ns: f64,
    next_start_ns: f64,
    piece_ns: f64,
    take_ns: f64,
    take_handover_ns: f64,
    deliver_ns: f64,
    deliver_handover_ns: f64,
    steal_ns: f64,
}

pub(super) fn json<'a>(view: &ForecastView<'a>) -> String {
    let forecast = view.forecast;
    let item = |strategy, point: &'a ForecastPoint| ForecastEntry {
        strategy,
        point,
        difference: point.difference(),
    };
    let items = forecast
        .curves
        .iter()
        .flat_map(|curve| curve.points.iter().map(move |point| item(curve.strategy, point)));
    json::text(&ForecastDocument {
        schema: SCHEMA,
        scene: view.scene,
        width: view.width,
        height: view.height,
        tile: view.tile,
        rounds: forecast.comparison.rounds,
        digest: forecast.comparison.digest.to_string(),
        machine: view.machine,
        noise: view.noise,
        assumptions: ASSUMPTIONS,
        slowdowns: &forecast.slowdowns,
        reference_median_ns: forecast.comparison.reference_ns(),
        results: items.collect(),
        laws: forecast.curves.iter().map(laws).collect(),
        unavailable: &forecast.unavailable,
    })
}

fn laws(curve: &ForecastCurve) -> LawsEntry<'_> {
    let Overheads { start, next_start, piece, take, deliver, steal } = curve.overheads;
    LawsEntry {
        strategy: curve.strategy,
        amdahl: curve.amdahl.map(|Law { serial, error, .. }| AmdahlLaw { serial, error }),
        usl: curve.usl.map(|law| UslLaw {
            sigma: law.serial,
            kappa: law.crosstalk,
            error: law.error,
            peak: law.peak(),
        }),
        overheads: OverheadsEntry {
            start_ns: start,
            next_start_ns: next_start,
            piece_ns: piece,
            take_ns: take.hold,
            take_handover_ns: take.handover,
            deliver_ns: deliver.hold,
            deliver_handover_ns: deliver.handover,
            steal_ns: steal,
        },
    }
}
