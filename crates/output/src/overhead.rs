//! The result of `rayweave overhead` as a table and as JSON.

use crate::json;
use crate::machine;
use crate::{noise, style};
use rayweave_measure::overhead::{LARGEST_SIDE, OverheadRow, OverheadStudy, PIXEL_NS, TASKS, TILE};
use rayweave_measure::{Interval, Machine, Noise};
use serde::Serialize;

/// The schema number of the JSON. It changes when a key is removed or changes its meaning.
const SCHEMA: u32 = 1;

const HEADER: [&str; 10] = [
    "strategy",
    "threads",
    "piece",
    "dispatch, ns a piece\non 1 thread",
    "dispatch, ns a piece\non all threads",
    "METG(50 %)\nus",
    "break-even\npixels",
    "prepare\nus",
    "first\nus",
    "later\nus",
];

/// The columns of numbers.
const NUMBERS: std::ops::RangeInclusive<usize> = 3..=9;

/// The costs of all strategies, with the machine and its noise.
#[derive(Clone, Copy, Debug)]
pub struct OverheadView<'a> {
    /// The measured costs.
    pub study: &'a OverheadStudy,
    /// The machine that ran the measurement.
    pub machine: &'a Machine,
    /// Other activity on the machine meanwhile.
    pub noise: &'a Noise,
}

impl OverheadView<'_> {
    /// Returns a table with a row for each strategy, without a newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        let OverheadStudy { rows, step_ns, rounds } = self.study;
        let complaints = rows.iter().filter_map(|row| row.figures.as_ref().err());
        let mut lines = vec![
            format!("synthetic work, {rounds} interleaved rounds, every image verified"),
            String::new(),
            style::table(HEADER, rows.iter().map(cells), NUMBERS),
            String::new(),
        ];
        lines.extend(complaints.map(ToString::to_string));
        lines.push(format!(
            "dispatch: time of each additional piece with almost no work [95 % interval].\n\
             METG(50 %): duration of the smallest piece that keeps half of the best efficiency,\n\
             with {TASKS} pieces, or one for each thread with bands. \
             One step of the work takes {step_ns:.2} ns.\n\
             break-even: side of the smallest square image, at {PIXEL_NS} ns a pixel, that is \
             faster than the\nreference (tiles of {TILE}; up to {LARGEST_SIDE} pixels).\n\
             first, later: first and third rendering of a small image after preparation."
        ));
        lines.push(noise::text(self.noise));
        lines.push(machine::text(self.machine));
        lines.join("\n")
    }

    /// Returns a JSON object of schema 1 with a result for each strategy. Times are in nanoseconds.
    /// A figure that could not be measured is null, and `error` says why.
    #[must_use]
    pub fn json(&self) -> String {
        let OverheadStudy { rows, step_ns, rounds } = self.study;
        json::text(&OverheadDocument {
            schema: SCHEMA,
            rounds: *rounds,
            step_ns: *step_ns,
            tasks: TASKS,
            break_even_pixel_ns: PIXEL_NS,
            break_even_largest_side: LARGEST_SIDE,
            noise: self.noise,
            machine: self.machine,
            results: rows.iter().map(OverheadEntry::new).collect(),
        })
    }
}

fn cells(row: &OverheadRow) -> [String; HEADER.len()] {
    let none = || "-".to_owned();
    let dispatch = |interval: Option<Interval>| {
        interval.map_or_else(none, |Interval { median, low, high }| {
            format!("{median:.1} [{low:.1}, {high:.1}]")
        })
    };
    let microseconds = |ns: f64| style::significant(ns / 1e3);
    let [one, all, metg, side, prepare, first, later] = match &row.figures {
        Err(_) => std::array::from_fn(|_| none()),
        Ok(figures) => [
            dispatch(figures.dispatch_one),
            dispatch(figures.dispatch_all),
            figures.metg.map_or_else(|| "< 1 step".to_owned(), microseconds),
            figures.break_even.map_or_else(none, |side| format!("{0:.0} x {0:.0}", side.ceil())),
            microseconds(figures.prepare.median),
            microseconds(figures.first.median),
            microseconds(figures.later.median),
        ],
    };
    let (threads, piece) = (row.threads.to_string(), row.granularity.to_string());
    [row.strategy.to_owned(), threads, piece, one, all, metg, side, prepare, first, later]
}

#[derive(Serialize)]
struct OverheadDocument<'a> {
    schema: u32,
    rounds: usize,
    step_ns: f64,
    tasks: u32,
    break_even_pixel_ns: f64,
    break_even_largest_side: u32,
    noise: &'a Noise,
    machine: &'a Machine,
    results: Vec<OverheadEntry<'a>>,
}

#[derive(Serialize)]
struct OverheadEntry<'a> {
    strategy: &'a str,
    threads: usize,
    piece: String,
    dispatch_one_ns: Option<Interval>,
    dispatch_all_ns: Option<Interval>,
    metg_ns: Option<f64>,
    break_even_side: Option<f64>,
    prepare_ns: Option<Interval>,
    first_ns: Option<Interval>,
    later_ns: Option<Interval>,
    error: Option<String>,
}

impl<'a> OverheadEntry<'a> {
    fn new(row: &'a OverheadRow) -> Self {
        let figures = row.figures.as_ref().ok();
        Self {
            strategy: row.strategy,
            threads: row.threads,
            piece: row.granularity.to_string(),
            dispatch_one_ns: figures.and_then(|figures| figures.dispatch_one),
            dispatch_all_ns: figures.and_then(|figures| figures.dispatch_all),
            metg_ns: figures.and_then(|figures| figures.metg),
            break_even_side: figures.and_then(|figures| figures.break_even),
            prepare_ns: figures.map(|figures| figures.prepare),
            first_ns: figures.map(|figures| figures.first),
            later_ns: figures.map(|figures| figures.later),
            error: row.figures.as_ref().err().map(ToString::to_string),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixtures::noise;
    use rayweave_contract::Granularity;
    use rayweave_measure::overhead::{Failure, OverheadFigures};

    fn study() -> OverheadStudy {
        let interval = |median| Interval { median, low: median - 1.0, high: median + 1.0 };
        let figures = OverheadFigures {
            dispatch_one: Some(interval(5.0)),
            dispatch_all: Some(interval(80.0)),
            metg: Some(234.0),
            break_even: Some(40.2),
            prepare: interval(90_000.0),
            first: interval(120_500.0),
            later: interval(8_000.0),
        };
        let row = |strategy, piece, figures| OverheadRow {
            strategy,
            granularity: piece,
            threads: 2,
            figures,
        };
        let bands = OverheadFigures {
            dispatch_one: None,
            dispatch_all: None,
            metg: None,
            break_even: None,
            ..figures
        };
        let rows = vec![
            row("rows", Granularity::Row, Ok(figures)),
            row("bands", Granularity::Band, Ok(bands)),
            row(
                "none",
                Granularity::Tile,
                Err(Failure::Preparing("none: unavailable here".to_owned())),
            ),
        ];
        OverheadStudy { rows, step_ns: 2.0, rounds: 7 }
    }

    #[test]
    fn the_table_has_figures_and_complaints() {
        let (study, machine) = (study(), Machine::here());
        let table = OverheadView { study: &study, machine: &machine, noise: &noise() }.table();
        let line = |name: &str| {
            let line = table
                .lines()
                .find(|line| line.starts_with(name))
                .unwrap_or_else(|| panic!("{table}"));
            line.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(
            line("rows "),
            "rows 2 row 5.0 [4.0, 6.0] 80.0 [79.0, 81.0] 0.234 41 x 41 90.0 120 8.00"
        );
        assert_eq!(line("bands "), "bands 2 band - - < 1 step - 90.0 120 8.00");
        assert_eq!(line("none "), "none 2 tile - - - - - - -");
        assert!(table.contains("\nnone: unavailable here\n"), "{table}");
    }

    #[test]
    fn json_keeps_nanoseconds_and_says_why_there_are_none() {
        let (study, machine) = (study(), Machine::here());
        let text = OverheadView { study: &study, machine: &machine, noise: &noise() }.json();
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let [rows, bands, none] = [0, 1, 2].map(|index| &value["results"][index]);
        assert!(value["noise"]["disturbed"].is_boolean(), "{text}");
        assert_eq!(
            (&rows["metg_ns"], &rows["dispatch_all_ns"]["high"]),
            (&234.0.into(), &81.0.into())
        );
        assert!(bands["dispatch_one_ns"].is_null() && bands["error"].is_null());
        assert!(none["prepare_ns"].is_null());
        assert_eq!(none["error"], "none: unavailable here");
    }
}
