//! The comparison for people.

use super::{BothReport, Report, Subject, baseline, search};
use crate::{machine, noise, style};
use rayweave_contract::Threads;
use rayweave_core::{Formulas, Sampling, Search};
use rayweave_measure::Comparison;
use rayweave_measure::compare::{Rays, Role, Row};

const HEADER: [&str; 10] = [
    "strategy",
    "threads",
    "median\nms",
    "one shot\nms",
    "speed-up\n[95 % interval]",
    "efficiency",
    "serial\nfraction",
    "rays",
    "threads\nstart",
    "identical",
];

/// The columns of numbers, which line up at their right.
const NUMBERS: std::ops::RangeInclusive<usize> = 1..=7;

/// How far from 1 the control's interval reaches where the table tells little.
const TELLING: f64 = 0.05;

/// What a cell without a figure holds.
const NONE: &str = "-";

pub(super) fn text(report: &Report<'_>) -> String {
    let mut lines = measured(report);
    lines.extend(legend(report.comparison));
    lines.extend(control(report.comparison));
    lines.extend(goal(report.comparison));
    lines.push(noise::text(report.noise));
    lines.push(machine::text(report.machine));
    if let Some(baseline) = report.baseline {
        lines.extend([String::new(), baseline::text(baseline, report)]);
    }
    lines.join("\n")
}

pub(super) fn both(report: &BothReport<'_>) -> String {
    let mut lines = Vec::new();
    for part in [&report.shared, &report.unshared] {
        lines.extend(measured(part));
        lines.extend(control(part.comparison));
        lines.extend(goal(part.comparison));
        lines.push(String::new());
    }
    let shared = &report.shared;
    lines.extend(legend(shared.comparison));
    lines.extend(report.gain().map(|gain| {
        format!(
            "sharing: without it {} takes {} times as long; both tables are of the same rounds.",
            reference(shared.comparison),
            style::interval(gain)
        )
    }));
    lines.push(noise::text(shared.noise));
    lines.push(machine::text(shared.machine));
    lines.join("\n")
}

/// The table with its heading, and what is said of this table alone.
fn measured(report: &Report<'_>) -> Vec<String> {
    let Report { subject, comparison, .. } = report;
    let rows = comparison.rows.iter().map(|row| cells(subject, row));
    let table = style::table(HEADER, rows, NUMBERS);
    let mut lines = vec![heading(report), String::new(), table, String::new()];
    lines.extend(comparison.rows.iter().filter_map(complaint));
    lines.push(computed(subject));
    lines
}

pub(super) fn heading(Report { subject, comparison, .. }: &Report<'_>) -> String {
    let rays = match (subject.antialiasing, subject.sampling) {
        (0, _) => "one ray a pixel".to_owned(),
        (density, Sampling::Lattice) if subject.adaptive => {
            format!("antialiasing {density} (adaptive)")
        }
        (density, Sampling::Lattice) => format!("antialiasing {density}"),
        (density, sampling) => format!("antialiasing {density} by {sampling}"),
    };
    let interrupted = if comparison.interrupted { "interrupted after " } else { "" };
    format!(
        "{}, {} x {} pixels, {rays}, {}, tiles of {}; {interrupted}{} interleaved rounds, digest {}",
        subject.scene,
        subject.width,
        subject.height,
        subject.precision,
        subject.tile,
        comparison.rounds,
        comparison.digest.short()
    )
}

/// What a row is called.
pub(super) fn label(row: &Row) -> String {
    let control = if row.role == Role::Control { " (control)" } else { "" };
    format!("{}{control}", row.strategy)
}

fn cells(subject: &Subject, row: &Row) -> [String; HEADER.len()] {
    let figure = |text: Option<String>| text.unwrap_or_else(|| NONE.to_owned());
    let figures = row.figures;
    let identical = match (&row.error, row.identical) {
        (Some(_), _) => "failed",
        (None, true) => "yes",
        (None, false) => "NO",
    };
    let start = match row.threads_start {
        Threads::None => None,
        Threads::Pool => figures.map(|f| format!("before: {:.0} us", f.prepare_ns / 1e3)),
        Threads::PerRender => Some("in the time".to_owned()),
    };
    [
        label(row),
        row.threads.to_string(),
        figure(figures.map(|f| milliseconds(f.median_ns))),
        figure(figures.and_then(|f| f.one_shot).map(|one_shot| milliseconds(one_shot.median_ns))),
        figure(figures.map(|f| style::interval(f.speedup))),
        figure(figures.map(|f| format!("{:.0} %", f.efficiency * 100.0))),
        figure(figures.and_then(|f| f.serial_fraction).map(|fraction| format!("{fraction:.3}"))),
        figure(row.rays.map(|counted| rays(subject, counted))),
        figure(start),
        identical.to_owned(),
    ]
}

/// Down to a microsecond, and no more digits than a measurement supports.
pub(super) fn milliseconds(ns: f64) -> String {
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

/// A pixel, and how many more they are than what was needed.
pub(super) fn rays(subject: &Subject, Rays { primary, redundant }: Rays) -> String {
    let a_pixel = primary as f64 / (f64::from(subject.width) * f64::from(subject.height));
    let percent = redundant as f64 / primary.saturating_sub(redundant).max(1) as f64 * 100.0;
    let decimals = usize::from(percent < 100.0);
    format!("{a_pixel:.1}/px +{percent:.decimals$} %")
}

/// How the picture was computed, as far as that changes no bits.
pub(super) fn computed(subject: &Subject) -> String {
    let lanes = match subject.lanes {
        1 => "rays one by one".to_owned(),
        lanes => format!("{lanes} rays side by side"),
    };
    let samples = match (subject.antialiasing, subject.sampling) {
        (0, _) | (_, Sampling::Importance) => "no samples to share",
        _ if subject.adaptive => "samples shared or interpolated",
        _ if subject.share_samples => "samples shared",
        _ => "samples not shared",
    };
    let search = match (subject.formulas, subject.search) {
        (Formulas::Textbook, Search::Auto) => "exhaustive, as the textbook's formulas need it",
        _ => search(subject.search),
    };
    format!("computed: {lanes}, {samples}, search {search}")
}

/// What is wrong with a row, if anything.
pub(crate) fn complaint(row: &Row) -> Option<String> {
    let plural = if row.threads == 1 { "" } else { "s" };
    let who = format!("{}, {} thread{plural}", row.strategy, row.threads);
    match (&row.error, row.digest) {
        (Some(error), _) => {
            Some(format!("{who}: failed after {} samples: {error}", row.samples.len()))
        }
        (None, Some(digest)) if !row.identical => {
            let samples = row.samples.len();
            Some(format!(
                "{who}: a wrong picture, digest {}, after {samples} right ones",
                digest.short()
            ))
        }
        _ => None,
    }
}

/// How the columns are meant.
fn legend(comparison: &Comparison) -> [String; 4] {
    let reference = reference(comparison);
    [
        "median: of second renderings, each in a process of its own; threads started \"before\" are not in it."
            .to_owned(),
        "one shot: preparing and the first rendering there, of a single picture. All pictures are verified untimed."
            .to_owned(),
        format!(
            "speed-up: time of {reference} over the row's, median over the rounds. Serial fraction: Karp and Flatt."
        ),
        "rays: primary ones, counted in the warm-up; + those that the whole picture as a single tile would not need."
            .to_owned(),
    ]
}

/// What the control says of the table.
fn control(comparison: &Comparison) -> Option<String> {
    let (reference, control) = (reference(comparison), comparison.control()?);
    let far = (control.high - 1.0).max(1.0 - control.low);
    let (wide, percent) = (far > TELLING, far * 100.0);
    let verdict = match (control.contains(1.0), wide) {
        (true, false) => "as it should be, 1 is in it.".to_owned(),
        (true, true) => format!("1 is in it, but it reaches {percent:.0} % from there."),
        (false, _) => "1 is not in it: measure again.\n\
                       Chance alone keeps it out of at most one quiet run in twenty."
            .to_owned(),
    };
    let note = if wide {
        format!(
            "\nBelieve no difference between rows below {percent:.0} %: measure longer (--time-limit, --precision-goal), \
             or on a quieter machine."
        )
    } else if control.contains(1.0) {
        "\nThat much is order and drift, of one thread; to tell rows apart compare their own intervals."
            .to_owned()
    } else {
        String::new()
    };
    Some(format!(
        "control: {reference} over itself is {}; {verdict}{note}",
        style::precise_interval(control)
    ))
}

/// Whether the rows are as precise as was wished for.
fn goal(comparison: &Comparison) -> Option<String> {
    let goal = comparison.goal?;
    Some(match comparison.imprecise_rows() {
        0 => format!("goal: each speed-up is known to +-{:.3} % or better.", goal * 100.0),
        missed => {
            let why = if comparison.interrupted {
                "it was interrupted"
            } else {
                "time was up. Give more, --time-limit SECONDS"
            };
            format!("goal: {missed} speed-ups are not known to +-{:.3} %: {why}.", goal * 100.0)
        }
    })
}

fn reference(comparison: &Comparison) -> &'static str {
    comparison.rows.first().map_or("the reference", |row| row.strategy)
}

#[cfg(test)]
mod tests {
    use super::super::tests::comparison;
    use super::*;
    use rayweave_measure::Interval;

    /// Catches a control that reassures however little it tells.
    #[test]
    fn a_control_says_what_is_to_be_believed() {
        let told = |median, low, high| {
            let mut comparison = comparison();
            comparison.rows[1].figures.as_mut().expect("figures").speedup =
                Interval { median, low, high };
            control(&comparison).expect("a control")
        };
        assert_eq!(
            told(1.0, 0.951, 1.049),
            "control: sequential over itself is 1.000 [0.951, 1.049]; as it should be, 1 is in it.\n\
             That much is order and drift, of one thread; to tell rows apart compare their own intervals."
        );
        assert_eq!(
            told(0.97, 0.952, 0.98),
            "control: sequential over itself is 0.970 [0.952, 0.980]; 1 is not in it: measure again.\n\
             Chance alone keeps it out of at most one quiet run in twenty."
        );
        assert_eq!(
            told(1.0, 0.939, 1.11),
            "control: sequential over itself is 1.000 [0.939, 1.110]; 1 is in it, but it reaches 11 % from there.\n\
             Believe no difference between rows below 11 %: measure longer (--time-limit, --precision-goal), or on a \
             quieter machine."
        );
        assert_eq!(
            told(0.8, 0.7, 0.91),
            "control: sequential over itself is 0.800 [0.700, 0.910]; 1 is not in it: measure again.\n\
             Chance alone keeps it out of at most one quiet run in twenty.\n\
             Believe no difference between rows below 30 %: measure longer (--time-limit, --precision-goal), or on a \
             quieter machine."
        );
    }
}
