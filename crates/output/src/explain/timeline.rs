//! The drawing of a time line: a bar for each thread, from start to end of the rendering.

use super::{color, label, runs, shaded};
use crate::plot::Drawn;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use rayweave_measure::explanation::ExplainedStrategy;

/// Width of the drawing in pixels.
const WIDTH: u32 = 1200;

/// Height of a thread's lane in pixels.
const LANE: u32 = 52;

/// Height of everything around the lanes in pixels.
const FRAME: u32 = 110;

/// The colour of a thread without a piece.
const IDLE: RGBColor = RGBColor(235, 235, 235);

/// Draws the time line of a strategy.
pub(super) fn draw(row: &ExplainedStrategy, text: &mut String) -> Drawn {
    let timeline = &row.timeline;
    let lanes = timeline.lanes.len().max(row.threads);
    let height =
        u32::try_from(lanes).unwrap_or(u32::MAX).saturating_mul(LANE).saturating_add(FRAME);
    let root = SVGBackend::with_string(text, (WIDTH, height)).into_drawing_area();
    root.fill(&WHITE)?;
    let wall = milliseconds(timeline.wall_ns);
    let title =
        format!("{}, {} threads: pieces of each thread; grey: none", row.strategy, row.threads);
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .build_cartesian_2d(0.0..wall, 0.0..lanes as f64)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .y_labels(0)
        .x_desc("ms since the rendering began")
        .draw()?;
    for index in 0..lanes {
        // The first thread is on top. Its bar is below its name.
        let bottom = (lanes - 1 - index) as f64;
        let bar = |begin: f64, end: f64| [(begin, bottom + 0.05), (end, bottom + 0.6)];
        chart.draw_series([Rectangle::new(bar(0.0, wall), IDLE.filled())])?;
        let Some(lane) = timeline.lanes.get(index) else {
            chart.draw_series([above(format!("{}: no piece", label(None, index)), bottom)])?;
            continue;
        };
        let bars = runs::of(lane, row.long_gap_ns).into_iter().enumerate().map(|(place, run)| {
            // Neighbouring pieces differ in colour.
            let color = if place % 2 == 0 { color(index) } else { shaded(color(index)) };
            Rectangle::new(
                bar(milliseconds(run.begin_ns), milliseconds(run.end_ns)),
                color.filled(),
            )
        });
        chart.draw_series(bars)?;
        let name = label(lane.name.as_deref(), index);
        let busy = 100.0 * lane.busy_ns() as f64 / timeline.wall_ns.max(1) as f64;
        chart.draw_series([above(format!("{name}: computes {busy:.1} % of the time"), bottom)])?;
    }
    root.present()?;
    Ok(())
}

/// Returns a text above a thread's bar.
fn above(text: String, bottom: f64) -> Text<'static, (f64, f64), String> {
    let style = TextStyle::from(("sans-serif", 13)).pos(Pos::new(HPos::Left, VPos::Bottom));
    Text::new(text, (0.0, bottom + 0.63), style)
}

fn milliseconds(ns: u64) -> f64 {
    ns as f64 / 1e6
}
