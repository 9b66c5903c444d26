//! The plot of time against error on logarithmic axes.

use super::TradeoffView;
use crate::plot::Drawn;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use rayweave_accuracy::metrics::psnr;
use rayweave_accuracy::tradeoff::{ARITHMETICS, Setting, TradeoffRow};
use rayweave_core::{Arithmetic, Sampling};

/// Width and height of the plot in pixels.
const SIZE: (u32, u32) = (1400, 1100);

/// Smaller errors are drawn here: 120 dB.
const LEAST_ERROR: f64 = 1e-6;

/// The colours of the depths: all bounces, one, none.
const COLORS: [RGBColor; 3] =
    [RGBColor(0, 90, 181), RGBColor(220, 110, 0), RGBColor(120, 120, 120)];

/// The radius of a marker, in pixels.
const MARKER: i32 = 3;

const FRONT: RGBColor = RGBColor(200, 30, 60);

type Axes = (std::ops::Range<f64>, std::ops::Range<f64>);

/// Draws a panel for each arithmetic.
pub(super) fn draw(view: &TradeoffView<'_>, text: &mut String) -> Drawn {
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title =
        format!("{}, {} x {} pixels: time against error", view.scene, view.width, view.height);
    let root = root.titled(&title, ("sans-serif", 24))?;
    let axes = axes(&view.study.rows);
    for (panel, arithmetic) in root.split_evenly((2, 2)).iter().zip(ARITHMETICS) {
        draw_panel(view, panel, arithmetic, &axes)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(
    view: &TradeoffView<'_>,
    panel: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    arithmetic: Arithmetic,
    (times, errors): &Axes,
) -> Drawn {
    let mut chart = ChartBuilder::on(panel)
        .caption(arithmetic.to_string(), ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(times.clone().log_scale(), errors.clone().log_scale())?;
    chart
        .configure_mesh()
        .x_desc("time of an image, ms")
        .y_desc("RMSE from the filter's limit (PSNR)")
        .x_label_formatter(&|ms| if *ms < 1.0 { format!("{ms}") } else { format!("{ms:.0}") })
        .y_label_formatter(&|rmse| format!("{rmse:.0e} ({:.0})", psnr(*rmse)))
        .light_line_style(RGBColor(240, 240, 240))
        .draw()?;
    let front = view.front().into_iter().map(place);
    chart
        .draw_series(LineSeries::new(front, FRONT.mix(0.5).stroke_width(2)))?
        .label("Pareto front of all panels")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], FRONT.mix(0.5).stroke_width(2)));

    let rows = || view.study.rows.iter().filter(|row| row.setting.arithmetic == arithmetic);
    let mut depths: Vec<u32> = Vec::new();
    for row in rows() {
        if !depths.contains(&row.setting.max_reflections) {
            depths.push(row.setting.max_reflections);
        }
    }
    for (depth, color) in depths.into_iter().zip(COLORS) {
        let series = |sampling, adaptive| {
            let wanted = move |setting: &Setting| {
                (setting.max_reflections, setting.sampling, setting.adaptive)
                    == (depth, sampling, adaptive)
            };
            rows().filter(move |row| wanted(&row.setting)).map(place)
        };
        chart
            .draw_series(
                series(Sampling::Lattice, false).map(|at| Circle::new(at, MARKER, color.filled())),
            )?
            .label(format!("lattice, bounces: {depth}"))
            .legend(move |(x, y)| Circle::new((x + 8, y), MARKER, color.filled()));
        chart
            .draw_series(
                series(Sampling::Importance, false)
                    .map(|at| TriangleMarker::new(at, MARKER + 2, color.filled())),
            )?
            .label(format!("importance, bounces: {depth}"))
            .legend(move |(x, y)| TriangleMarker::new((x + 8, y), MARKER + 2, color.filled()));
        // Only settings with all bounces are adaptive: the other depths get no legend.
        let mut adaptive = series(Sampling::Lattice, true).peekable();
        if adaptive.peek().is_some() {
            chart
                .draw_series(adaptive.map(|at| Cross::new(at, MARKER, color.stroke_width(2))))?
                .label(format!("adaptive lattice, bounces: {depth}"))
                .legend(move |(x, y)| Cross::new((x + 8, y), MARKER, color.stroke_width(2)));
        }
        let of_depth = rows().filter(|row| row.setting.max_reflections == depth);
        chart.draw_series(of_depth.map(|row| label(row, &color)))?;
    }
    let in_front = rows().filter(|row| row.in_front).map(place);
    chart.draw_series(in_front.map(|at| Circle::new(at, MARKER + 4, FRONT.stroke_width(1))))?;
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(RGBColor(200, 200, 200))
        .draw()?;
    Ok(())
}

/// Returns the number of rays a pixel, above a point of the lattice and below any other point.
fn label<'a>(row: &TradeoffRow, color: &'a RGBColor) -> Text<'a, Point, String> {
    let above = row.setting.sampling == Sampling::Lattice && !row.setting.adaptive;
    let place_of_text = if above { VPos::Bottom } else { VPos::Top };
    let style =
        TextStyle::from(("sans-serif", 11)).color(color).pos(Pos::new(HPos::Center, place_of_text));
    let (time, error) = place(row);
    let gap = if above { 1.06 } else { 1.0 / 1.06 };
    Text::new(row.setting.rays_per_pixel().to_string(), (time, error * gap), style)
}

type Point = (f64, f64);

fn place(row: &TradeoffRow) -> Point {
    (row.median_ns / 1e6, row.error.rmse.max(LEAST_ERROR))
}

/// Returns the ranges of times and errors that contain every point, with a margin.
fn axes(rows: &[TradeoffRow]) -> Axes {
    let range = |of: fn(Point) -> f64| {
        let values = || rows.iter().map(place).map(of);
        values().fold(f64::INFINITY, f64::min) / 1.3..values().fold(0.0, f64::max) * 1.3
    };
    (range(|point| point.0), range(|point| point.1))
}
