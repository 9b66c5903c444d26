//! The list as a table for people, one for each subject.

use super::verdict::trust;
use super::{Record, Results, Subject, changes, control, short};
use crate::{machine, noise, style};
use rayweave_measure::Measurement;

/// A column of the table.
struct Column {
    /// The name on the command line.
    name: &'static str,
    /// The heading, with up to two lines.
    heading: &'static str,
    /// True if the column lines up at its right.
    is_number: bool,
    /// Returns the cell of a record, or `None` without a figure.
    cell: fn(&Record) -> Option<String>,
}

/// All columns in their order.
const COLUMNS: [Column; 11] = [
    column("strategy", "strategy", false, |record| Some(record.label())),
    column("threads", "threads", true, |record| Some(record.measurement.threads.to_string())),
    column("median", "median\nms", true, |record| record.measurement.median_ns.map(milliseconds)),
    column("cold", "cold\nms", true, |record| record.measurement.cold_ns.map(milliseconds)),
    column("speed-up", "speed-up\n[95 % interval]", true, |record| {
        record.measurement.speedup.map(style::interval)
    }),
    column("efficiency", "efficiency", true, |record| record.measurement.efficiency.map(percent)),
    column("serial", "serial\nfraction", true, |record| {
        record.measurement.serial_fraction.map(|fraction| format!("{fraction:.3}"))
    }),
    column("rays", "rays", true, |record| {
        let Measurement { primary_rays, redundant_rays, .. } = record.measurement;
        Some(rays_a_pixel(&record.subject, primary_rays?, redundant_rays?))
    }),
    column("lanes", "lanes\nin use", true, |record| record.lanes_in_use().map(percent)),
    column("start", "threads\nstart", false, |record| match &*record.measurement.starts_threads {
        "pool" => {
            record.measurement.prepare_ns.map(|ns| format!("before: {:.0} us", ns as f64 / 1e3))
        }
        "per-render" => Some("in the time".to_owned()),
        _ => None,
    }),
    column("identical", "identical", false, |record| {
        let identical = match (&record.measurement.error, record.measurement.identical) {
            (Some(_), _) => "failed",
            (None, true) => "yes",
            (None, false) => "NO",
        };
        Some(identical.to_owned())
    }),
];

const fn column(
    name: &'static str,
    heading: &'static str,
    is_number: bool,
    cell: fn(&Record) -> Option<String>,
) -> Column {
    Column { name, heading, is_number, cell }
}

/// Returns the names of all columns of [`Results::table`].
pub fn column_names() -> impl Iterator<Item = &'static str> {
    COLUMNS.iter().map(|column| column.name)
}

/// The cell without a figure.
const NONE: &str = "-";

/// Returns the tables with these columns, or with all if none is named.
pub(super) fn text(results: &Results, names: &[String]) -> String {
    let mut columns: Vec<&Column> =
        names.iter().filter_map(|name| COLUMNS.iter().find(|column| column.name == name)).collect();
    if columns.is_empty() {
        columns = COLUMNS.iter().collect();
    }
    let mut lines: Vec<String> = Vec::new();
    for group in results.groups() {
        lines.extend(measured(group, &columns));
        lines.extend(control(group).map(trust));
        lines.extend(results.precision_goal.map(|goal| goal_line(group, goal)));
        lines.push(String::new());
    }
    lines.extend(legend(&results.results));
    lines.extend(results.sharing_speedup.map(|gain| {
        format!(
            "sharing: without it {} takes {} times as long, in the same rounds.",
            reference(&results.results),
            style::interval(gain)
        )
    }));
    lines.push(noise::text(&results.noise));
    lines.push(machine::text(&results.machine));
    lines.extend(changes::text(results, style::precise_interval));
    lines.join("\n")
}

/// Returns the heading of a subject's table, the table, and what concerns this table alone.
fn measured(group: &[Record], columns: &[&Column]) -> Vec<String> {
    let cell = |column: &&Column, record| (column.cell)(record).unwrap_or_else(|| NONE.to_owned());
    let rows = group
        .iter()
        .map(|record| columns.iter().map(|column| cell(column, record)).collect::<Vec<_>>());
    let numbers = (0..columns.len()).filter(|&place| columns[place].is_number);
    let table = style::table(columns.iter().map(|column| column.heading), rows, numbers);
    let mut lines = vec![heading(group), String::new(), table, String::new()];
    lines.extend(group.iter().filter_map(|record| complaint(&record.measurement)));
    lines.push(computed(&group[0].subject));
    lines
}

pub(super) fn heading(group: &[Record]) -> String {
    let Record { subject, rounds, interrupted, reference_digest, .. } = &group[0];
    let interrupted = if *interrupted { "interrupted after " } else { "" };
    format!(
        "{}, {} x {} pixels, {}, {}, tiles of {}; {interrupted}{rounds} interleaved rounds, digest \
         {}",
        subject.scene,
        subject.width,
        subject.height,
        rays_each(subject),
        subject.precision,
        subject.tile,
        short(reference_digest)
    )
}

/// Returns the number of rays for a pixel, and how it is chosen.
pub(super) fn rays_each(subject: &Subject) -> String {
    let density = u64::from(subject.antialiasing);
    let lattice = (2 * density + 1).pow(2);
    match (density, &*subject.sampling) {
        (0, _) => "one ray each".to_owned(),
        (_, "lattice") if subject.adaptive => format!("up to {lattice} rays each"),
        (_, "lattice") => format!("{lattice} rays each"),
        (n, sampling) => format!("{} rays each by {sampling}", n * n + (n + 1) * (n + 1)),
    }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

/// Returns a time in milliseconds with no more digits than a measurement supports.
pub(super) fn milliseconds(ns: u64) -> String {
    let ms = ns as f64 / 1e6;
    let decimals = if ms < 10.0 {
        3
    } else if ms < 1000.0 {
        1
    } else {
        0
    };
    format!("{ms:.decimals$}")
}

/// Returns the primary rays of a pixel, and the share by which they exceed the needed ones.
pub(super) fn rays_a_pixel(subject: &Subject, primary: u64, redundant: u64) -> String {
    let a_pixel = primary as f64 / (f64::from(subject.width) * f64::from(subject.height));
    let percent = redundant as f64 / primary.saturating_sub(redundant).max(1) as f64 * 100.0;
    let decimals = usize::from(percent < 100.0);
    format!("{a_pixel:.1}/px +{percent:.decimals$} %")
}

/// Returns the settings of the execution, which change no bits.
pub(super) fn computed(subject: &Subject) -> String {
    let lanes = match subject.lanes {
        1 => "rays one by one".to_owned(),
        lanes => format!("{lanes} rays side by side"),
    };
    let samples = match (subject.has_lattice(), subject.shares_samples()) {
        (false, _) => "no samples to share",
        (true, true) if subject.adaptive => "samples shared or interpolated",
        (true, true) => "samples shared",
        (true, false) => "samples not shared",
    };
    let accel = match (&*subject.formulas, &*subject.accel) {
        ("textbook", "auto") => "none (the textbook formulas allow no other)",
        (_, accel) => accel,
    };
    format!("computed: {lanes}, {samples}, acceleration {accel}")
}

/// Returns what is wrong with a row, if anything.
pub(crate) fn complaint(row: &Measurement) -> Option<String> {
    let plural = if row.threads == 1 { "" } else { "s" };
    let who = format!("{}, {} thread{plural}", row.strategy, row.threads);
    let samples = row.samples_ns.len();
    match (&row.error, row.digest) {
        (Some(error), _) => Some(format!("{who}: failed after {samples} samples: {error}")),
        (None, Some(digest)) if !row.identical => Some(format!(
            "{who}: wrong image (digest {}) after {samples} correct ones",
            digest.short()
        )),
        _ => None,
    }
}

/// Returns the meaning of the columns.
fn legend(records: &[Record]) -> [String; 5] {
    let reference = reference(records);
    [
        "median: time of the second rendering in each process, without threads started \"before\"."
            .to_owned(),
        "cold: preparation and first rendering in each process. All images are verified, untimed."
            .to_owned(),
        format!(
            "speed-up: time of {reference} over the row's, median over rounds. \
             Serial fraction: Karp and Flatt."
        ),
        "rays: primary rays, counted in the warm-up; +: more than the image needs as a single tile."
            .to_owned(),
        "lanes in use: share of the lanes that primary rays filled, counted in the warm-up."
            .to_owned(),
    ]
}

/// Returns whether the rows are as precise as was asked for.
pub(super) fn goal_line(group: &[Record], goal: f64) -> String {
    let speedups = group.iter().filter_map(|record| record.measurement.speedup);
    match speedups.filter(|interval| interval.relative_half_width() > goal).count() {
        0 => format!("goal: each speed-up is known to +-{:.3} % or better.", goal * 100.0),
        missed => {
            let why = if group[0].interrupted {
                "the run was interrupted"
            } else {
                "the time limit was reached; raise it with --time-limit SECONDS"
            };
            format!("goal: {missed} speed-ups are not known to +-{:.3} %: {why}.", goal * 100.0)
        }
    }
}

pub(super) fn reference(group: &[Record]) -> &str {
    group.first().map_or("the reference", |record| &record.measurement.strategy)
}
