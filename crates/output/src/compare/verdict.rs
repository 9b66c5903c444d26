//! The sentences on which strategies are fastest, and on which differences to trust.

use super::ranking::{Section, distance_from_1, percent_up, speedup};
use super::table::reference;
use super::{Record, control};
use rayweave_measure::Interval;

/// The distance from 1 from which the control's interval calls for a better measurement.
const WIDE_CONTROL: f64 = 0.05;

/// Returns the sentences on a subject's records: one for each number of threads, and a warning
/// where they are uncertain.
pub(super) fn sentences(group: &[Record], sections: &[Section<'_>]) -> Vec<String> {
    if sections.is_empty() {
        return vec![format!("Only {} was measured, so nothing is compared.", reference(group))];
    }
    let mut lines: Vec<String> = sections.iter().map(sentence).collect();
    if sections.iter().any(|section| !section.is_certain()) {
        let against_itself = control(group).map(against_itself).unwrap_or_default();
        lines.push(format!("The figures are too uncertain to rely on{against_itself}."));
    }
    lines
}

fn sentence(section: &Section<'_>) -> String {
    let on = threads(section.threads);
    let (alike, behind) = section.ranked();
    let Some(&best) = alike.first() else {
        return format!("On {on} no strategy gave figures to compare.");
    };
    let name = &best.measurement.strategy;
    if section.threads == 1 {
        let (who, range) = match &section.rows[..] {
            [_] => (format!("{name} is"), range(&section.rows, 2)),
            rows => ("the strategies are".to_owned(), range(rows, 2)),
        };
        return format!("On {on} {who} {range} times as fast as the plain loop.");
    }
    if !section.pays_off() {
        let Interval { median, low, high } =
            best.measurement.speedup.unwrap_or(Interval::exactly(0.0));
        return format!(
            "On {on} no strategy is seen to be faster than the plain loop on one thread; the \
             highest median is {name}, {median:.2} ({low:.2}-{high:.2})."
        );
    }
    let times = format!("{} times as fast as one thread", range(&alike, 1));
    let others = match &behind[..] {
        [] => String::new(),
        [(record, ratio)] => {
            let percent = percent_longer(ratio.median);
            format!("; {} takes {percent} % longer", record.measurement.strategy)
        }
        several => {
            let [least, most] = [f64::min, f64::max]
                .map(|by| several.iter().map(|(_, ratio)| ratio.median).reduce(by).unwrap_or(1.0));
            let [least, most] = [least, most].map(percent_longer);
            let range = if least == most { most } else { format!("{least} to {most}") };
            format!("; the others take {range} % longer")
        }
    };
    match (alike.len(), behind.len() + section.failed.len()) {
        (1, 0) => format!("On {on} {name} is {times}."),
        (1, _) => format!("Fastest on {on}: {name}, {times}{others}."),
        (all, 0) => {
            format!("On {on} no difference is seen between the {all} strategies: they are {times}.")
        }
        _ => format!(
            "Fastest on {on}: {}, which cannot be told apart: {times}{others}.",
            names(&alike)
        ),
    }
}

/// Returns the speed-ups of rows, the fastest first.
fn range(rows: &[&Record], decimals: usize) -> String {
    let ends = [rows.last(), rows.first()].map(|row| row.map_or(0.0, |row| speedup(row)));
    let [least, most] = ends.map(|speedup| format!("{speedup:.decimals$}"));
    if most == least { most } else { format!("{least} to {most}") }
}

/// Returns up to three names; of more rows, two names and the number of the others.
pub(super) fn names(rows: &[&Record]) -> String {
    let names: Vec<&str> = rows.iter().map(|row| &*row.measurement.strategy).collect();
    match &names[..] {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [one, two] => format!("{one} and {two}"),
        [one, two, three] => format!("{one}, {two} and {three}"),
        [one, two, others @ ..] => format!("{one}, {two} and {} others", others.len()),
    }
}

/// Returns by how many percent a time is longer, given its ratio.
pub(super) fn percent_longer(ratio: f64) -> String {
    format!("{:.0}", (ratio - 1.0) * 100.0)
}

/// Returns a number of threads in words.
pub(super) fn threads(threads: usize) -> String {
    if threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") }
}

/// Returns which differences to trust, by the reference's time over its own.
pub(super) fn trust(control: Interval) -> String {
    let far = distance_from_1(control);
    let Interval { low, high, .. } = control;
    if !control.contains(1.0) {
        return format!(
            "One thread against itself is {low:.2}-{high:.2}, which does not contain 1: measure \
             again. On a quiet machine at most one run in twenty does this by chance."
        );
    }
    let advice = if far > WIDE_CONTROL {
        " Measure longer (--time-limit) or on a quieter machine."
    } else {
        ""
    };
    format!(
        "Ignore differences below {}{}; for larger ones compare the intervals.{advice}",
        percent_up(far),
        against_itself(control)
    )
}

fn against_itself(control: Interval) -> String {
    format!(" (one thread against itself: {:.2}-{:.2})", control.low, control.high)
}
