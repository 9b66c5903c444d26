//! The forecast for people.

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
        "{scene}, {width} x {height} pixels, tiles of {tile}: predicted speed-up by number of threads"
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
    "speed-up: over sequential rendering on one thread of this machine.\n\
     Amdahl (1967) and USL (Gunther, 1993), fitted by least squares to what the strategy makes of its own single thread:\n\
     the serial share; sigma, waiting for turns; kappa, each thread's cost to each other; peak, threads beyond which more\n\
     are slower. ±: by how much the law misses the points, root mean square. A law that misses them explains nothing."
}

/// Predictions beside what was measured; none where no number of threads asked for is here.
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
        "{}\n{within} of {} within 5 %",
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

/// What the predictions were made from.
fn basis(view: &ForecastView<'_>) -> String {
    let forecast = view.forecast;
    let slowdowns = forecast.slowdowns.iter().map(|&Slowdown { threads, factor: slowdown }| {
        let used = if slowdown.median < 1.0 { "by chance, 1 is used" } else { "used" };
        let slowdown = style::precise_interval(slowdown);
        format!("{threads} threads that share nothing take {slowdown} times as long as one, each: {used}.")
    });
    let reference = forecast
        .comparison
        .reference_ns()
        .map(|ns| format!("the reference takes {:.2} ms.", ns / 1e6));
    let rounds = format!(
        "measured: {} interleaved rounds, every picture verified; predicted from pieces timed one by one on one thread, in \
         the same rounds, and from the overheads of threads.",
        forecast.comparison.rounds
    );
    slowdowns.chain(reference).chain([rounds]).collect::<Vec<_>>().join("\n")
}
