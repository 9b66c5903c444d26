//! A comparison as table, JSON and CSV.

mod csv;
mod json;
mod table;
#[cfg(test)]
mod tests;

use rayweave_core::{Formulas, Sampling, ThreadsStart};
use rayweave_measure::{Comparison, Machine, Row};

/// What was rendered.
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
    /// Of the tracer.
    pub formulas: Formulas,
    /// Of the numbers that the tracer computes with: "f32" or "f64".
    pub precision: String,
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
}

impl Report<'_> {
    /// For people: a heading, the table, and notes on how to read it. Plain text without colours,
    /// without a newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        table::text(self)
    }

    /// For programs: an object of schema 1. More keys may come, these stay:
    ///
    /// * `schema`, `scene`, `width`, `height`, `machine`, `results`;
    /// * of each result `strategy`, `threads`, `identical`, `digest`, `median_ns`, `samples_ns` and
    ///   `speedup` with `median`, `low` and `high`.
    ///
    /// Where a row has no figures, because it failed or gave a wrong picture, they are null.
    #[must_use]
    pub fn json(&self) -> String {
        json::text(self)
    }

    /// For spreadsheets: a line of names, then one line a result; empty where there is no figure.
    #[must_use]
    pub fn csv(&self) -> String {
        csv::text(self)
    }
}

/// The word for where a row's threads are started.
fn threads_start(row: &Row) -> &'static str {
    match row.threads_start {
        ThreadsStart::Never => "never",
        ThreadsStart::Prepare => "prepare",
        ThreadsStart::Render => "render",
    }
}
