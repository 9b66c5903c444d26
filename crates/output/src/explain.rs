//! Why strategies lose: as tables, JSON, traces and pictures.

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

use ExplanationView as Report;

/// An explanation with everything that is needed to read it.
#[derive(Clone, Copy)]
pub struct ExplanationView<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Of the picture, in pixels.
    pub size: (u32, u32),
    /// The side of a tile, in pixels.
    pub tile: u32,
    /// What was measured.
    pub explanation: &'a Explanation,
    /// The primary rays of a piece.
    pub rays: &'a RayCost<'a>,
    /// What it was measured on.
    pub machine: &'a Machine,
    /// What else went on there.
    pub noise: &'a Noise,
}

impl ExplanationView<'_> {
    /// For people: of each strategy where its thread-time goes, what each thread does, and what
    /// helps. Without a newline at the end.
    #[must_use]
    pub fn text(&self) -> String {
        table::text(self)
    }

    /// For programs: an object of schema 1. Each of its `results` has `strategy`, `threads`,
    /// `wall_ns`, `speedup`, `lost_ns`, `losses_ns` with a key for each cause, `unexplained_ns`,
    /// and what each of the `threads_recorded` did in the quickest of the recorded renderings.
    /// `noise` is that of a comparison, in docs/compare-json.md.
    #[must_use]
    pub fn json(&self) -> String {
        json::text(self)
    }

    /// The time lines in the trace event format, for Perfetto (<https://ui.perfetto.dev>) and
    /// Chrome's tracing page. Single pixels that a thread computes one after the other in a row are
    /// one slice.
    #[must_use]
    pub fn trace(&self) -> String {
        trace::text(self)
    }

    /// Of a strategy a bar for each thread, as SVG.
    ///
    /// # Errors
    ///
    /// It cannot be drawn.
    pub fn timeline(&self, row: &ExplainedStrategy) -> Result<String, String> {
        timeline::svg(row)
    }

    /// Of a strategy the time of each piece a pixel, as SVG with a scale.
    ///
    /// # Errors
    ///
    /// It cannot be drawn.
    pub fn cost(&self, row: &ExplainedStrategy) -> Result<String, String> {
        map::cost(row, self.size)
    }

    /// Of a strategy each pixel in the colour that the thread that computed it has in the time
    /// line.
    ///
    /// # Errors
    ///
    /// There is no such picture.
    pub fn owners(&self, row: &ExplainedStrategy) -> Result<Image, ImageError> {
        Ok(map::owners(&row.timeline, Image::new(self.size.0, self.size.1)?))
    }
}

/// What one thread did in a rendering; in JSON by these names.
#[derive(Serialize)]
struct Thread<'a> {
    name: Option<&'a str>,
    /// Of its first piece.
    begin_ns: u64,
    /// Of its last piece.
    end_ns: u64,
    busy_ns: u64,
    between_ns: u64,
    /// Before its first piece and after its last.
    idle_ns: u64,
    pieces: usize,
    pixels: u64,
    /// `None` if they cannot be counted.
    primary_rays: Option<u64>,
    long_gaps: usize,
    /// Of all of them together.
    long_gaps_ns: u64,
}

impl<'a> Thread<'a> {
    /// Those of a row's time line.
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

/// The most that a thread computes over the mean of all that there are, in time; 1 is even, the
/// number of threads is all on one.
fn imbalance(row: &ExplainedStrategy) -> f64 {
    let busy = || row.timeline.lanes.iter().map(|lane| lane.busy_ns() as f64);
    let mean = busy().sum::<f64>() / row.threads.max(1) as f64;
    if mean > 0.0 { busy().fold(0.0, f64::max) / mean } else { 1.0 }
}

/// What a thread is called: as it calls itself, or by its place in the order of the first pieces.
fn label(name: Option<&str>, index: usize) -> String {
    name.map_or_else(|| format!("thread {index}"), str::to_owned)
}

/// A colour a thread, by Okabe and Ito, "Color Universal Design", 2008; they come again after the
/// eighth.
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

/// The same colour, a little darker.
fn shaded(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let [red, green, blue] = [red, green, blue].map(|channel| channel - channel / 5);
    RGBColor(red, green, blue)
}

/// Of a cause, for a table and for a sentence.
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
