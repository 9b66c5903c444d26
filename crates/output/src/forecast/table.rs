//! The predictions, and the measurements that check them, as tables.

use super::{ASSUMPTIONS, ForecastView};
use crate::compare::complaint;
use crate::{machine, noise, style};
use rayweave_measure::forecast::{ForecastCurve, ForecastPoint, Slowdown};

const NONE: &str = "-";

pub(super) fn text(view: &ForecastView<'_>) -> String {
    let forecast = view.forecast;
    let mut parts = vec![heading(view), predictions(&forecast.curves), laws_legend().to_owned()];
    parts.extend(checks(&forecast.curves));
    parts.push(basis(view));
    let complaints = forecast.comparison.rows.iter().filter_map(complaint);
    let complaints: Vec<String> = complaints.chain(forecast.unavailable.iter().cloned()).collect();
    parts.extend((!complaints.is_empty()).then(|| complaints.join("\n")));
    parts.push(format!("assumed: {}.", ASSUMPTIONS.join(";\n")));
    parts.push(format!("{}\n{}", noise::text(view.noise), machine::text(view.machine)));
    parts.join("\n\n")
}

fn heading(view: &ForecastView<'_>) -> String {
    let ForecastView { scene, width, height, tile, .. } = view;
    format!(
        "{scene}, {width} x {height} pixels, tiles of {tile}: predicted speed-up by number of \
         threads"
    )
}

fn predictions(curves: &[ForecastCurve]) -> String {
    let threads = curves.first().map(|curve| &curve.points[..]).unwrap_or_default();
    let numbers = threads.iter().map(|point| point.threads.to_string());
    let laws = ["Amdahl:\nserial", "USL:\nsigma", "\nkappa", "\npeak"].map(str::to_owned);
    let header: Vec<String> =
        std::iter::once("strategy".to_owned()).chain(numbers).chain(laws).collect();
    let last = header.len() - 1;
    let rows = curves.iter().map(|curve| {
        let points = curve.points.iter().map(|point| style::significant(point.predicted));
        std::iter::once(curve.strategy.to_owned())
            .chain(points)
            .chain(laws_of(curve))
            .collect::<Vec<_>>()
    });
    style::table(header, rows, 1..=last)
}

fn laws_of(curve: &ForecastCurve) -> [String; 4] {
    let figure = |value: Option<String>| value.unwrap_or_else(|| NONE.to_owned());
    let peak = curve.usl.and_then(|law| law.peak()).map(|threads| format!("{threads:.0}"));
    [
        figure(curve.amdahl.map(|law| format!("{:.4} ±{:.0} %", law.serial, 100.0 * law.error))),
        figure(curve.usl.map(|law| format!("{:.4}", law.serial))),
        figure(
            curve
                .usl
                .map(|law| format!("{} ±{:.0} %", crosstalk(law.crosstalk), 100.0 * law.error)),
        ),
        figure(peak),
    ]
}

fn crosstalk(share: f64) -> String {
    if share == 0.0 { "0".to_owned() } else { format!("{share:.1e}") }
}

fn laws_legend() -> &'static str {
    "speed-up: relative to sequential rendering on one thread of this machine.\n\
     Amdahl (1967) and USL (Gunther, 1993) are fitted by least squares to the speed-ups of each \
     strategy\nover its own single thread. serial: share that does not run in parallel. sigma: \
     share that waits for\na turn. kappa: cost of each pair of threads. peak: more threads than \
     this are slower. ±: root mean\nsquare error of the fit; a law with a large error explains \
     nothing."
}

/// Returns the predictions beside the measurements, if this machine has any of the numbers of
/// threads.
fn checks(curves: &[ForecastCurve]) -> Option<String> {
    let rows: Vec<[String; 5]> = curves
        .iter()
        .flat_map(|curve| curve.points.iter().filter_map(|point| check(curve, point)))
        .collect();
    if rows.is_empty() {
        return None;
    }
    let differences: Vec<f64> = curves
        .iter()
        .flat_map(|curve| &curve.points)
        .filter_map(ForecastPoint::difference)
        .collect();
    let within = differences.iter().filter(|difference| difference.abs() <= 0.05).count();
    let header = ["strategy", "threads", "predicted", "measured\n[95 % interval]", "difference"];
    Some(format!(
        "{}\n{within} of {} predictions within 5 %",
        style::table(header, rows.into_iter(), 1..=4),
        differences.len()
    ))
}

fn check(curve: &ForecastCurve, point: &ForecastPoint) -> Option<[String; 5]> {
    Some([
        curve.strategy.to_owned(),
        point.threads.to_string(),
        format!("{:.2}", point.predicted),
        style::interval(point.measured?),
        format!("{:+.1} %", 100.0 * point.difference()?),
    ])
}

/// Returns the measurements that the predictions start from.
fn basis(view: &ForecastView<'_>) -> String {
    let forecast = view.forecast;
    let slowdowns = forecast.slowdowns.iter().map(|&Slowdown { threads, factor: slowdown }| {
        let by_chance =
            if slowdown.median < 1.0 { " Less than 1 is chance: 1 is used." } else { "" };
        format!(
            "Each of {threads} threads that share nothing takes {} times as long as one thread \
             alone.{by_chance}",
            style::precise_interval(slowdown)
        )
    });
    let reference = forecast
        .comparison
        .reference_ns()
        .map(|ns| format!("The reference takes {:.2} ms.", ns / 1e6));
    let rounds = format!(
        "Measured in {} interleaved rounds, every image verified. Predicted from the time of each \
         piece on\none thread, in the same rounds, and from the overheads of threads.",
        forecast.comparison.rounds
    );
    slowdowns.chain(reference).chain([rounds]).collect::<Vec<_>>().join("\n")
}
