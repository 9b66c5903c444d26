//! The explanation for people.

use super::{ExplanationView, Thread, imbalance, label, name};
use crate::{machine, noise, style};
use rayweave_measure::efficiency::Cause;
use rayweave_measure::explanation::{ExplainedStrategy, Explanation};

/// A share of the thread-time below which nothing is worth a word.
const NOTABLE: f64 = 0.01;

pub(super) fn text(view: &ExplanationView<'_>) -> String {
    let mut lines = Vec::new();
    let unit = Unit::of(view.explanation);
    for row in &view.explanation.rows {
        lines.extend([heading(view.explanation, row, unit), String::new()]);
        lines.extend([causes(view.explanation, row, unit), String::new()]);
        lines.extend([sum(row, unit), recording(row), String::new()]);
        lines.extend([threads(view, row, unit), String::new()]);
        lines.extend([gaps(row), advice(row), String::new()]);
    }
    lines.extend(legend(view.explanation));
    lines.push(noise::text(view.noise));
    lines.push(machine::text(view.machine));
    lines.join("\n")
}

fn heading(explanation: &Explanation, row: &ExplainedStrategy, unit: Unit) -> String {
    let Explanation { reference, reference_ns, rounds, .. } = explanation;
    let ExplainedStrategy { strategy, threads, wall_ns, .. } = row;
    let (speedup, name) = (reference_ns / wall_ns, unit.name);
    format!(
        "{strategy} on {threads} thread{}: {} {name}, {reference} {} {name}: speed-up {speedup:.2}, efficiency {:.0} %; \
         the quickest of {rounds} rounds",
        plural(*threads),
        unit.text(*wall_ns),
        unit.text(*reference_ns),
        100.0 * speedup / *threads as f64,
    )
}

/// Where the thread-time goes.
fn causes(explanation: &Explanation, row: &ExplainedStrategy, unit: Unit) -> String {
    let all = row.thread_time_ns();
    let cells = |label: &str, ns: f64, sign: f64| {
        let share = ns / all;
        let speedup = sign * share * row.threads as f64;
        [
            label.to_owned(),
            unit.text(ns),
            format!("{:.1} %", 100.0 * share),
            format!("{speedup:+.2}"),
        ]
    };
    let useful = cells("useful work", explanation.reference_ns, 1.0);
    let lost = Cause::ALL.map(|cause| cells(name(cause), row.lost_time.to(cause), -1.0));
    let rest = cells("not explained", row.unexplained_ns(), -1.0);
    let rows = [useful].into_iter().chain(lost).chain([rest]);
    style::table(["thread-time", unit.name, "", "speed-up"], rows, 1..=3)
}

fn sum(row: &ExplainedStrategy, unit: Unit) -> String {
    let (explained, lost) = (row.lost_time.total_ns(), row.lost_ns);
    // Of next to nothing there is no percentage.
    let share = if lost.abs() < NOTABLE * row.thread_time_ns() {
        "less than 1 % of the thread-time".to_owned()
    } else {
        format!("{:.0} %", 100.0 * explained / lost)
    };
    format!(
        "adds up to {} of {} {} lost ({share})",
        unit.text(explained),
        unit.text(lost),
        unit.name
    )
}

fn recording(row: &ExplainedStrategy) -> String {
    format!(
        "recorded renderings take {} times as long as plain ones",
        style::precise_interval(row.recorded)
    )
}

/// What each thread does.
fn threads(view: &ExplanationView<'_>, row: &ExplainedStrategy, unit: Unit) -> String {
    let timed = |what| format!("{what}\n{}", unit.name);
    let header = [
        "thread".to_owned(),
        timed("begins"),
        timed("busy"),
        timed("between"),
        timed("idle"),
        "pieces".to_owned(),
        "pixels".to_owned(),
        "rays".to_owned(),
        "long\ngaps".to_owned(),
        timed("of"),
    ];
    let count =
        |count: Option<u64>| count.map_or_else(|| "-".to_owned(), |count| count.to_string());
    let cells = |(index, thread): (usize, Thread<'_>)| {
        [
            label(thread.name, index),
            unit.text(thread.begin_ns as f64),
            unit.text(thread.busy_ns as f64),
            unit.text(thread.between_ns as f64),
            unit.text(thread.idle_ns as f64),
            thread.pieces.to_string(),
            thread.pixels.to_string(),
            count(thread.primary_rays),
            thread.long_gaps.to_string(),
            unit.text(thread.long_gaps_ns as f64),
        ]
    };
    let without = row.threads.saturating_sub(row.timeline.lanes.len());
    let table =
        style::table(header, Thread::all(row, view.rays).into_iter().enumerate().map(cells), 1..=9);
    match without {
        0 => table,
        1 => table + "\n1 more thread got no piece",
        several => table + &format!("\n{several} more threads got no piece"),
    }
}

fn gaps(row: &ExplainedStrategy) -> String {
    format!(
        "imbalance: the busiest thread computes {:.2} times the mean. Long gaps: over {:.1} us between two pieces, \
         which one thread alone has once in 1000.",
        imbalance(row),
        row.long_gap_ns / 1e3,
    )
}

/// The largest cause, and what helps; unless chance is larger.
fn advice(row: &ExplainedStrategy) -> String {
    let cause = row.lost_time.largest();
    let share = row.lost_time.to(cause) / row.thread_time_ns();
    if share < NOTABLE {
        return "No cause takes 1 % of the thread-time.".to_owned();
    }
    if row.unexplained_ns().abs() > row.lost_time.to(cause) {
        return "No verdict: recorded and plain renderings differ by more than any cause takes. Measure longer \
                (--time-limit), or on a quieter machine."
            .to_owned();
    }
    let help = match cause {
        Cause::Redundant => {
            "its pieces compute again what the pixels of a tile share; a strategy of larger pieces helps, or a larger \
             --tile"
        }
        Cause::Slowdown => {
            "the same pieces take longer when all threads compute: cores that share memory, clock or units, or other \
             programs; no strategy helps, fewer threads or a quiet machine may"
        }
        Cause::Dispatch => "there are many pieces for the work in each; larger ones help",
        Cause::Contention => {
            "threads hinder each other between pieces; writing without a lock helps, or taking it for larger pieces"
        }
        Cause::Imbalance => {
            "threads wait for the last; pieces that whoever is free takes help, and smaller ones at the end"
        }
        Cause::Serial => {
            "little is to be computed for what starting and ending takes; a larger picture helps, or threads that \
             stay"
        }
    };
    format!("Most is lost to {} ({:.0} %): {help}.", name(cause), 100.0 * share)
}

/// How the rows are meant.
fn legend(explanation: &Explanation) -> Vec<String> {
    let Explanation { reference, cost, .. } = explanation;
    vec![
        format!("useful work: {reference}'s time. redundant work: pieces of one thread alone, beyond {reference}'s."),
        "slowdown: pieces of all threads, beyond one thread's. dispatch: between pieces, of one thread alone."
            .to_owned(),
        "contention: between pieces, beyond that. imbalance: waiting for the last piece of all.".to_owned(),
        "serial part: before a thread's first piece and after the last of all. speed-up: what it takes of it."
            .to_owned(),
        format!(
            "recording took {:.0} ns a piece in it and {:.0} ns between two, which the causes are without; the threads \
             are those of the quickest recorded rendering, with it.",
            cost.inside_ns, cost.outside_ns
        ),
    ]
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// What times are told in, the same in all of a report, so that its strategies can be compared.
#[derive(Clone, Copy)]
struct Unit {
    name: &'static str,
    ns: f64,
    decimals: usize,
}

/// Renderings that take less are told in microseconds.
const SHORT_NS: f64 = 10e6;

impl Unit {
    /// By the shortest rendering.
    fn of(explanation: &Explanation) -> Self {
        let shortest = explanation.rows.iter().map(|row| row.wall_ns).fold(f64::INFINITY, f64::min);
        if shortest < SHORT_NS {
            Self { name: "us", ns: 1e3, decimals: 1 }
        } else {
            Self { name: "ms", ns: 1e6, decimals: 2 }
        }
    }

    fn text(self, ns: f64) -> String {
        format!("{:.*}", self.decimals, ns / self.ns)
    }
}
