//! The comparison for people.

use super::Report;
use crate::{machine, style};
use rayweave_core::{Sampling, ThreadsStart};
use rayweave_measure::compare::{Role, Row};
use rayweave_measure::{Comparison, Interval};

const HEADER: [&str; 8] = [
    "strategy",
    "threads",
    "median\nms",
    "speed-up\n[95 % interval]",
    "efficiency",
    "serial\nfraction",
    "threads\nstart",
    "identical",
];

/// The columns of numbers, which line up at their right.
const NUMBERS: std::ops::RangeInclusive<usize> = 1..=5;

/// What a cell without a figure holds.
const NONE: &str = "-";

pub(super) fn text(report: &Report<'_>) -> String {
    let Report { comparison, .. } = report;
    let table = style::table(HEADER, comparison.rows.iter().map(cells), NUMBERS);
    let mut lines = vec![heading(report), String::new(), table, String::new()];
    lines.extend(comparison.rows.iter().filter_map(complaint));
    lines.extend(notes(comparison));
    lines.push(machine::text(report.machine));
    lines.join("\n")
}

fn heading(Report { subject, comparison, .. }: &Report<'_>) -> String {
    let rays = match (subject.antialiasing, subject.sampling) {
        (0, _) => "one ray a pixel".to_owned(),
        (density, Sampling::Lattice) => format!("antialiasing {density}"),
        (density, sampling) => format!("antialiasing {density} by {sampling}"),
    };
    format!(
        "{}, {} x {} pixels, {rays}, {}, tiles of {}; {} interleaved rounds, digest {}",
        subject.scene,
        subject.width,
        subject.height,
        subject.precision,
        subject.tile,
        comparison.rounds,
        comparison.digest.short()
    )
}

fn cells(row: &Row) -> [String; HEADER.len()] {
    let figure = |text: Option<String>| text.unwrap_or_else(|| NONE.to_owned());
    let figures = row.figures;
    let control = if row.role == Role::Control { " (control)" } else { "" };
    let identical = match (&row.error, row.identical) {
        (Some(_), _) => "failed",
        (None, true) => "yes",
        (None, false) => "NO",
    };
    let start = match row.threads_start {
        ThreadsStart::Never => None,
        ThreadsStart::Prepare => figures.map(|f| format!("before: {:.0} us", f.prepare_ns / 1e3)),
        ThreadsStart::Render => Some("in the time".to_owned()),
    };
    [
        format!("{}{control}", row.strategy),
        row.threads.to_string(),
        figure(figures.map(|f| milliseconds(f.median_ns))),
        figure(figures.map(|f| style::interval(f.speedup))),
        figure(figures.map(|f| format!("{:.0} %", f.efficiency * 100.0))),
        figure(figures.and_then(|f| f.serial_fraction).map(|fraction| format!("{fraction:.3}"))),
        figure(start),
        identical.to_owned(),
    ]
}

/// Down to a microsecond, and no more digits than a measurement supports.
fn milliseconds(ns: f64) -> String {
    let ms = ns / 1e6;
    let decimals = if ms < 10.0 {
        3
    } else if ms < 1000.0 {
        1
    } else {
        0
    };
    format!("{ms:.decimals$}")
}

/// What is wrong with a row, if anything.
fn complaint(row: &Row) -> Option<String> {
    let plural = if row.threads == 1 { "" } else { "s" };
    let who = format!("{}, {} thread{plural}", row.strategy, row.threads);
    match (&row.error, row.digest) {
        (Some(error), _) => Some(format!("{who}: failed after {} samples: {error}", row.samples.len())),
        (None, Some(digest)) if !row.identical => {
            let samples = row.samples.len();
            Some(format!("{who}: a wrong picture, digest {}, after {samples} right ones", digest.short()))
        }
        _ => None,
    }
}

fn notes(comparison: &Comparison) -> Vec<String> {
    let reference = comparison.rows.first().map_or("the reference", |row| row.strategy);
    let mut notes = vec![
        "time: rendering alone, each picture verified outside of it; threads started \"before\" it are not in it."
            .to_owned(),
        format!(
            "speed-up: time of {reference} over the row's, median over the rounds. Serial fraction: Karp and Flatt."
        ),
    ];
    notes.extend(comparison.control().map(|control| {
        let Interval { median, low, high } = control;
        let verdict = if control.contains(1.0) {
            "as it should be, 1 is in it.\n\
             That much is order and drift, of one thread; to tell rows apart compare their own intervals."
        } else {
            "1 is not in it: measure again.\n\
             Chance alone keeps it out of at most one quiet run in twenty."
        };
        format!("control: {reference} over itself is {median:.3} [{low:.3}, {high:.3}]; {verdict}")
    }));
    notes
}
