//! The plot of speed-up over threads on logarithmic axes.

use super::ForecastView;
use crate::plot::Drawn;
use plotters::prelude::*;
use rayweave_measure::forecast::ForecastCurve;

/// Width and height of the plot in pixels.
const SIZE: (u32, u32) = (1100, 800);

const GREY: RGBColor = RGBColor(170, 170, 170);

/// The radius of a marker, in pixels.
const MARKER: i32 = 4;

/// Draws a line and circles for each strategy.
pub(super) fn draw(view: &ForecastView<'_>, text: &mut String) -> Drawn {
    let curves = &view.forecast.curves;
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let ForecastView { scene, width, height, .. } = view;
    let title = format!(
        "{scene}, {width} x {height} pixels: speed-up, predicted (lines) and measured (circles)"
    );
    let (threads, speedups) = axes(curves);
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(
            threads.clone().log_scale().base(2.0),
            speedups.log_scale().base(2.0),
        )?;
    chart
        .configure_mesh()
        .x_desc("threads")
        .y_desc("speed-up over sequential")
        .x_label_formatter(&|threads| format!("{threads:.0}"))
        .y_label_formatter(&|speedup| {
            if *speedup < 1.0 { format!("{speedup:.2}") } else { format!("{speedup:.0}") }
        })
        .light_line_style(RGBColor(240, 240, 240))
        .draw()?;
    let ideal = [threads.start.max(1.0), threads.end].map(|threads| (threads, threads));
    chart
        .draw_series(LineSeries::new(ideal, GREY))?
        .label("ideal speed-up")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], GREY));
    for (index, curve) in curves.iter().enumerate() {
        let color = Palette99::pick(index).to_rgba();
        let predicted = curve.points.iter().map(|point| (point.threads as f64, point.predicted));
        chart
            .draw_series(LineSeries::new(predicted, color.stroke_width(2)))?
            .label(curve.strategy)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
        let measured = curve
            .points
            .iter()
            .filter_map(|point| Some((point.threads as f64, point.measured?.median)));
        chart.draw_series(measured.map(|at| Circle::new(at, MARKER, color.stroke_width(2))))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(GREY)
        .draw()?;
    root.present()?;
    Ok(())
}

/// Returns the ranges of threads and speed-ups that contain every point, with a margin.
fn axes(curves: &[ForecastCurve]) -> (std::ops::Range<f64>, std::ops::Range<f64>) {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let range = |values: &dyn Fn() -> Vec<f64>| {
        let values = values();
        let (low, high) =
            (values.iter().copied().fold(1.0, f64::min), values.into_iter().fold(1.0, f64::max));
        low / 1.3..high * 1.3
    };
    let speedups = || {
        let measured = points().filter_map(|point| point.measured).map(|measured| measured.median);
        points().map(|point| point.predicted).chain(measured).collect()
    };
    (range(&|| points().map(|point| point.threads as f64).collect()), range(&speedups))
}
