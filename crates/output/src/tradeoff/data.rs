//! The study for other programs: what a result is, is said once, for JSON and CSV.

use super::TradeoffView;
use crate::csv;
use crate::json;
use rayweave_accuracy::tradeoff::{ArithmeticCost, TradeoffRow, reference_rays_per_pixel};
use rayweave_measure::{Interval, Machine};
use serde::Serialize;

/// It changes when a key changes its meaning or goes.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Object<'a> {
    schema: u32,
    scene: &'a str,
    width: u32,
    height: u32,
    rounds: usize,
    machine: &'a Machine,
    reference: Reference,
    results: Vec<ResultWithSamples<'a>>,
    costs: Vec<CostEntry>,
}

#[derive(Serialize)]
struct Reference {
    rays_per_pixel: u32,
    rmse_estimate: f64,
}

#[derive(Serialize)]
struct ResultWithSamples<'a> {
    #[serde(flatten)]
    result: Entry,
    samples_ns: &'a [u64],
}

#[derive(Serialize)]
struct Entry {
    formulas: String,
    precision: String,
    sampling: String,
    antialiasing: u32,
    rays_per_pixel: u32,
    max_reflections: u32,
    median_ns: u64,
    speedup: f64,
    speedup_low: f64,
    speedup_high: f64,
    /// Null for an equal picture.
    psnr: Option<f64>,
    rmse: f64,
    max_error: f64,
    share_off: f64,
    flip: f64,
    arithmetic_rmse: f64,
    sampling_rmse: f64,
    pareto: bool,
}

#[derive(Serialize)]
struct CostEntry {
    part: &'static str,
    robust_over_textbook_f32: Interval,
    robust_over_textbook_f64: Interval,
    f64_over_f32_robust: Interval,
}

pub(super) fn json(view: &TradeoffView<'_>) -> String {
    let study = view.study;
    let with_samples = |row| ResultWithSamples { result: entry(row), samples_ns: &row.samples_ns };
    json::text(&Object {
        schema: SCHEMA,
        scene: view.scene,
        width: view.width,
        height: view.height,
        rounds: study.rounds,
        machine: view.machine,
        reference: Reference {
            rays_per_pixel: reference_rays_per_pixel(),
            rmse_estimate: study.reference.uncertainty,
        },
        results: study.rows.iter().map(with_samples).collect(),
        costs: study.costs.iter().map(cost).collect(),
    })
}

pub(super) fn csv(view: &TradeoffView<'_>) -> String {
    csv::text(view.study.rows.iter().map(entry))
}

fn entry(row: &TradeoffRow) -> Entry {
    let TradeoffRow { setting, speedup, error, .. } = row;
    Entry {
        formulas: setting.arithmetic.formulas.to_string(),
        precision: setting.arithmetic.precision.to_string(),
        sampling: super::sampling_name(setting),
        antialiasing: setting.antialiasing,
        rays_per_pixel: setting.rays_per_pixel(),
        max_reflections: setting.max_reflections,
        median_ns: row.median_ns.round() as u64,
        speedup: speedup.median,
        speedup_low: speedup.low,
        speedup_high: speedup.high,
        psnr: Some(error.psnr()).filter(|psnr| psnr.is_finite()),
        rmse: error.rmse,
        max_error: error.max,
        share_off: error.share_off,
        flip: error.flip,
        arithmetic_rmse: row.arithmetic_rmse,
        sampling_rmse: row.sampling_rmse,
        pareto: row.in_front,
    }
}

fn cost(cost: &ArithmeticCost) -> CostEntry {
    CostEntry {
        part: cost.part,
        robust_over_textbook_f32: cost.robust_f32,
        robust_over_textbook_f64: cost.robust_f64,
        f64_over_f32_robust: cost.f64_robust,
    }
}
