//! A comparison as table, JSON, CSV and Markdown, and what has changed since an earlier one.

mod baseline;
#[cfg(test)]
mod both_tests;
mod csv;
mod json;
mod markdown;
mod scenes;
mod table;
#[cfg(test)]
pub(crate) mod tests;

pub use baseline::Baseline;
pub use scenes::ScenesReport;
pub(crate) use table::complaint;

use rayweave_contract::Threads;
use rayweave_core::{Formulas, Sampling, Search};
use rayweave_measure::{Comparison, Interval, Machine, Noise, Row};

/// What was rendered, and how.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The scene's name.
    pub scene: String,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// The side of a tile, in pixels.
    pub tile: u32,
    /// Density of the samples; 0 is one ray a pixel.
    pub antialiasing: u32,
    /// Where the samples lie.
    pub sampling: Sampling,
    /// Whether those of a lattice are traced only where pixels differ.
    pub adaptive: bool,
    /// Of the tracer.
    pub formulas: Formulas,
    /// Of the numbers that the tracer computes with: "f32" or "f64".
    pub precision: String,
    /// Rays that are followed side by side.
    pub lanes: usize,
    /// Whether samples that neighbouring pixels of a tile have in common are traced once.
    pub share_samples: bool,
    /// Which primitives a ray tries.
    pub search: Search,
}

/// A comparison with everything that is needed to read it.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// What was rendered.
    pub subject: &'a Subject,
    /// What was measured.
    pub comparison: &'a Comparison,
    /// What it was measured on.
    pub machine: &'a Machine,
    /// What else went on there.
    pub noise: &'a Noise,
    /// An earlier comparison, to say what has changed.
    pub baseline: Option<&'a Baseline>,
}

impl Report<'_> {
    /// For people: a heading, the table, and notes on how to read it. Plain text without colours,
    /// without a newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        table::text(self)
    }

    /// For programs: an object of schema 1, which docs/compare-json.md describes. More keys may
    /// come, those there stay.
    #[must_use]
    pub fn json(&self) -> String {
        json::text(self)
    }

    /// For a README: the table in Markdown, with what was measured on.
    #[must_use]
    pub fn markdown(&self) -> String {
        markdown::text(self)
    }

    /// For spreadsheets: a line of names, then one line a result; empty where there is no figure.
    #[must_use]
    pub fn csv(&self) -> String {
        csv::text(self)
    }
}

/// The same strategies with samples shared and without, [measured together].
///
/// [measured together]: rayweave_measure::Protocol::run_together
#[derive(Clone, Copy, Debug)]
pub struct BothReport<'a> {
    /// With samples shared.
    pub shared: Report<'a>,
    /// Without; on the same machine.
    pub unshared: Report<'a>,
}

impl BothReport<'_> {
    /// As [`Report::table`], first with samples shared and then without, and below both what the
    /// reference gains.
    #[must_use]
    pub fn table(&self) -> String {
        table::both(self)
    }

    /// The object of [`Report::json`] with samples shared, and in it two more keys: `unshared` is
    /// such an object too, without, and `sharing_speedup` (as `speedup`) the reference's time
    /// without over its time with, or null.
    #[must_use]
    pub fn json(&self) -> String {
        json::both(self)
    }

    /// Both tables of [`Report::markdown`].
    #[must_use]
    pub fn markdown(&self) -> String {
        format!("{}\n{}", self.shared.markdown(), self.unshared.markdown())
    }

    /// The lines of [`Report::csv`] with samples shared, then those without: `share_samples` tells
    /// them apart.
    #[must_use]
    pub fn csv(&self) -> String {
        csv::both(self)
    }

    /// The time of the reference without samples shared over its time with, in the same round.
    fn gain(&self) -> Option<Interval> {
        self.shared.comparison.gain_over(self.unshared.comparison)
    }
}

/// The scene's file without its folder.
fn scene_file(scene: &str) -> &str {
    scene.rsplit(['/', '\\']).next().unwrap_or_default()
}

/// The word for how a ray's primitives are chosen.
fn search(search: Search) -> &'static str {
    match search {
        Search::Auto => "auto",
        Search::Exhaustive => "exhaustive",
    }
}

/// The word for where a row's threads are started.
fn threads_start(row: &Row) -> &'static str {
    match row.threads_start {
        Threads::None => "never",
        Threads::Pool => "prepare",
        Threads::PerRender => "render",
    }
}
