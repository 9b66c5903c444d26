//! The forecast for other programs.

use super::{ASSUMPTIONS, Report};
use crate::json;
use rayweave_measure::forecast::{ForecastCurve, ForecastPoint, Slowdown};
use rayweave_measure::{Machine, Noise};
use rayweave_predict::{Law, Overheads};
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
    rounds: usize,
    digest: String,
    machine: &'a Machine,
    noise: &'a Noise,
    assumptions: [&'a str; 5],
    slowdowns: &'a [Slowdown],
    reference_median_ns: Option<f64>,
    results: Vec<Item<'a>>,
    laws: Vec<Laws<'a>>,
    unavailable: &'a [String],
}

#[derive(Serialize)]
struct Item<'a> {
    strategy: &'a str,
    #[serde(flatten)]
    point: &'a ForecastPoint,
    difference: Option<f64>,
}

#[derive(Serialize)]
struct Laws<'a> {
    strategy: &'a str,
    amdahl: Option<AmdahlLaw>,
    usl: Option<UslLaw>,
    overheads: Costs,
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
struct Costs {
    start_ns: f64,
    next_start_ns: f64,
    piece_ns: f64,
    take_ns: f64,
    take_handover_ns: f64,
    deliver_ns: f64,
    deliver_handover_ns: f64,
    steal_ns: f64,
}

pub(super) fn json<'a>(report: &Report<'a>) -> String {
    let forecast = report.forecast;
    let item = |strategy, point: &'a ForecastPoint| Item {
        strategy,
        point,
        difference: point.difference(),
    };
    let items = forecast
        .curves
        .iter()
        .flat_map(|curve| curve.points.iter().map(move |point| item(curve.strategy, point)));
    json::text(&Object {
        schema: SCHEMA,
        scene: report.scene,
        width: report.width,
        height: report.height,
        tile: report.tile,
        rounds: forecast.comparison.rounds,
        digest: forecast.comparison.digest.to_string(),
        machine: report.machine,
        noise: report.noise,
        assumptions: ASSUMPTIONS,
        slowdowns: &forecast.slowdowns,
        reference_median_ns: forecast.comparison.reference_ns(),
        results: items.collect(),
        laws: forecast.curves.iter().map(laws).collect(),
        unavailable: &forecast.unavailable,
    })
}

fn laws(curve: &ForecastCurve) -> Laws<'_> {
    let Overheads { start, next_start, piece, take, deliver, steal } = curve.overheads;
    Laws {
        strategy: curve.strategy,
        amdahl: curve.amdahl.map(|Law { serial, error, .. }| AmdahlLaw { serial, error }),
        usl: curve.usl.map(|law| UslLaw {
            sigma: law.serial,
            kappa: law.crosstalk,
            error: law.error,
            peak: law.peak(),
        }),
        overheads: Costs {
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
