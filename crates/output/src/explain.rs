//! The result of `rayweave explain` as tables, as JSON, as a trace and as drawings.

mod json;
mod map;
mod runs;
mod table;
#[cfg(test)]
mod tests;
mod timeline;
mod trace;

use plotters::style::RGBColor;
use rayweave_contract::{Image, ImageError};
use rayweave_measure::efficiency::Cause;
use rayweave_measure::explanation::{ExplainedStrategy, Explanation};
use rayweave_measure::recorder::RayCost;
use rayweave_measure::timeline::{Timeline, TimelineLane};
use rayweave_measure::{Machine, Noise};
use serde::Serialize;

/// The time breakdown of all strategies, with the scene, the machine and its noise.
#[derive(Clone, Copy)]
pub struct ExplanationView<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Width and height of the image in pixels.
    pub size: (u32, u32),
    /// The side of a tile in pixels.
    pub tile: u32,
    /// The measured times.
    pub explanation: &'a Explanation,
    /// The number of primary rays of a piece.
    pub rays: &'a RayCost<'a>,
    /// The machine that ran the measurement.
    pub machine: &'a Machine,
    /// Other activity on the machine meanwhile.
    pub noise: &'a Noise,
}

impl ExplanationView<'_> {
    /// Returns tables for each strategy: where its thread-time goes, what each thread does, and
    /// what helps. There is no newline at the end.
    #[must_use]
    pub fn text(&self) -> String {
        table::text(self)
    }

    /// Returns a JSON object of schema 1. Each of its `results` has `strategy`, `threads`,
    /// `wall_ns`, `speedup`, `lost_ns`, `losses_ns` with a key for each cause, `unexplained_ns`,
    /// and the activity of each of the `threads_recorded` in the quickest recorded rendering.
    /// `noise` is that of a comparison, in docs/compare-json.md.
    #[must_use]
    pub fn json(&self) -> String {
        json::text(self)
    }

    /// Returns the time lines in the trace event format, for Perfetto (<https://ui.perfetto.dev>)
    /// and Chrome's tracing page. Pixels that a thread computes one after the other in a row are
    /// one slice.
    #[must_use]
    pub fn trace(&self) -> String {
        trace::text(self)
    }

    /// Returns an SVG drawing of a strategy's time line with a bar for each thread.
    ///
    /// # Errors
    ///
    /// The plotting library failed; the message is its own.
    pub fn timeline(&self, row: &ExplainedStrategy) -> Result<String, String> {
        crate::plot::svg("the time line", |text| timeline::draw(row, text))
    }

    /// Returns an SVG map of the time that a strategy spent on each pixel, with a scale.
    ///
    /// # Errors
    ///
    /// The plotting library failed; the message is its own.
    pub fn cost(&self, row: &ExplainedStrategy) -> Result<String, String> {
        crate::plot::svg("the map of cost", |text| map::draw(row, self.size, text))
    }

    /// Returns an image with each pixel in the colour of the thread that computed it, as in the
    /// time line.
    ///
    /// # Errors
    ///
    /// An image of this size cannot exist.
    pub fn owners(&self, row: &ExplainedStrategy) -> Result<Image, ImageError> {
        Ok(map::owners(&row.timeline, Image::new(self.size.0, self.size.1)?))
    }
}

/// The activity of one thread in a rendering. The JSON has these names.
#[derive(Serialize)]
struct Thread<'a> {
    name: Option<&'a str>,
    /// The start of its first piece.
    begin_ns: u64,
    /// The end of its last piece.
    end_ns: u64,
    busy_ns: u64,
    between_ns: u64,
    /// The time before its first piece and after its last.
    idle_ns: u64,
    pieces: usize,
    pixels: u64,
    /// `None` if rays cannot be counted.
    primary_rays: Option<u64>,
    long_gaps: usize,
    /// The sum of the long gaps.
    long_gaps_ns: u64,
}

impl<'a> Thread<'a> {
    /// Returns the threads of a strategy's time line.
    fn all(row: &'a ExplainedStrategy, rays: &RayCost<'_>) -> Vec<Self> {
        let of = |lane| Self::of(lane, &row.timeline, row.long_gap_ns, rays);
        row.timeline.lanes.iter().map(of).collect()
    }

    fn of(
        lane: &'a TimelineLane,
        timeline: &Timeline,
        long_gap_ns: f64,
        rays: &RayCost<'_>,
    ) -> Self {
        let begin_ns = lane.pieces.first().map_or(0, |piece| piece.begin_ns);
        let end_ns = lane.pieces.last().map_or(0, |piece| piece.end_ns);
        let long_gaps = || lane.gaps_ns().filter(|&ns| ns as f64 > long_gap_ns);
        Self {
            name: lane.name.as_deref(),
            begin_ns,
            end_ns,
            busy_ns: lane.busy_ns(),
            between_ns: lane.gaps_ns().sum(),
            idle_ns: begin_ns + timeline.wall_ns.saturating_sub(end_ns),
            pieces: lane.pieces.len(),
            pixels: lane.pixels(),
            primary_rays: lane.pieces.iter().map(|piece| rays(piece.rect)).sum(),
            long_gaps: long_gaps().count(),
            long_gaps_ns: long_gaps().sum(),
        }
    }
}

/// Returns the busiest thread's computing time over the mean of all threads: 1 if all compute as
/// long, the number of threads if only one computes.
fn imbalance(row: &ExplainedStrategy) -> f64 {
    let busy = || row.timeline.lanes.iter().map(|lane| lane.busy_ns() as f64);
    let mean = busy().sum::<f64>() / row.threads.max(1) as f64;
    if mean > 0.0 { busy().fold(0.0, f64::max) / mean } else { 1.0 }
}

/// Returns the name of a thread, or a name from its place in the order of first pieces.
fn label(name: Option<&str>, index: usize) -> String {
    name.map_or_else(|| format!("thread {index}"), str::to_owned)
}

/// Returns the colour of a thread, one of eight by Okabe and Ito, "Color Universal Design", 2008.
fn color(thread: usize) -> RGBColor {
    const COLORS: [RGBColor; 8] = [
        RGBColor(0, 114, 178),
        RGBColor(230, 159, 0),
        RGBColor(0, 158, 115),
        RGBColor(204, 121, 167),
        RGBColor(86, 180, 233),
        RGBColor(213, 94, 0),
        RGBColor(240, 228, 66),
        RGBColor(120, 120, 120),
    ];
    COLORS[thread % COLORS.len()]
}

/// Returns a slightly darker colour.
fn shaded(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let [red, green, blue] = [red, green, blue].map(|channel| channel - channel / 5);
    RGBColor(red, green, blue)
}

/// Returns the name of a cause.
fn name(cause: Cause) -> &'static str {
    match cause {
        Cause::Redundant => "redundant work",
        Cause::Slowdown => "slowdown",
        Cause::Dispatch => "dispatch",
        Cause::Contention => "contention",
        Cause::Imbalance => "imbalance",
        Cause::Serial => "serial part",
    }
}
