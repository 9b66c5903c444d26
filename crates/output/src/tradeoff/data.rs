//! The settings as JSON and CSV, from one definition of a result.

use super::TradeoffView;
use crate::{csv, json};
use rayweave_accuracy::tradeoff::{ArithmeticCost, TradeoffRow, reference_rays_per_pixel};
use rayweave_measure::Machine;
use serde::Serialize;

/// The schema number of the JSON. It changes when a key is removed or changes its meaning.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct TradeoffDocument<'a> {
    schema: u32,
    scene: &'a str,
    width: u32,
    height: u32,
    rounds: usize,
    machine: &'a Machine,
    reference: ReferenceEntry,
    results: Vec<SettingWithSamples<'a>>,
    costs: &'a [ArithmeticCost],
}

#[derive(Serialize)]
struct ReferenceEntry {
    rays_per_pixel: u32,
    rmse_estimate: f64,
}

#[derive(Serialize)]
struct SettingWithSamples<'a> {
    #[serde(flatten)]
    setting: SettingEntry,
    samples_ns: &'a [u64],
}

#[derive(Serialize)]
struct SettingEntry {
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
    /// Null if the image equals the reference.
    psnr: Option<f64>,
    rmse: f64,
    max_error: f64,
    share_off: f64,
    flip: f64,
    arithmetic_rmse: f64,
    sampling_rmse: f64,
    pareto: bool,
}

pub(super) fn json(view: &TradeoffView<'_>) -> String {
    let study = view.study;
    let with_samples =
        |row| SettingWithSamples { setting: entry(row), samples_ns: &row.samples_ns };
    json::text(&TradeoffDocument {
        schema: SCHEMA,
        scene: view.scene,
        width: view.width,
        height: view.height,
        rounds: study.rounds,
        machine: view.machine,
        reference: ReferenceEntry {
            rays_per_pixel: reference_rays_per_pixel(),
            rmse_estimate: study.reference.uncertainty,
        },
        results: study.rows.iter().map(with_samples).collect(),
        costs: &study.costs,
    })
}

pub(super) fn csv(view: &TradeoffView<'_>) -> String {
    csv::text(view.study.rows.iter().map(entry))
}

fn entry(row: &TradeoffRow) -> SettingEntry {
    let TradeoffRow { setting, speedup, error, .. } = row;
    SettingEntry {
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
