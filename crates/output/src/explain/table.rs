//! The time breakdown as tables, with advice.

use super::{ExplanationView, Thread, imbalance, label, name};
use crate::{machine, noise, style};
use rayweave_measure::efficiency::Cause;
use rayweave_measure::explanation::{ExplainedStrategy, Explanation};

/// The smallest share of the thread-time that is worth mentioning.
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
        "{strategy} on {threads} thread{}: {} {name}, {reference} {} {name}: \
         speed-up {speedup:.2}, efficiency {:.0} %; the quickest of {rounds} rounds",
        plural(*threads),
        unit.text(*wall_ns),
        unit.text(*reference_ns),
        100.0 * speedup / *threads as f64,
    )
}

/// Returns the table of causes.
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
    // A percentage of almost nothing means nothing.
    let share = if lost.abs() < NOTABLE * row.thread_time_ns() {
        "less than 1 % of the thread-time".to_owned()
    } else {
        format!("{:.0} %", 100.0 * explained / lost)
    };
    format!(
        "explained: {} of {} {} lost ({share})",
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

/// Returns the table of threads.
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
        "imbalance: the busiest thread computes {:.2} times the mean.\n\
         long gaps: over {:.1} us between two pieces, as 1 gap in 1000 is on one thread alone.",
        imbalance(row),
        row.long_gap_ns / 1e3,
    )
}

/// Returns the largest cause and what helps, unless chance is larger.
fn advice(row: &ExplainedStrategy) -> String {
    let cause = row.lost_time.largest();
    let share = row.lost_time.to(cause) / row.thread_time_ns();
    if share < NOTABLE {
        return "No cause takes 1 % of the thread-time.".to_owned();
    }
    if row.unexplained_ns().abs() > row.lost_time.to(cause) {
        return "No verdict: recorded and plain renderings differ by more than the largest cause \
                takes.\nMeasure longer (--time-limit) or on a quieter machine."
            .to_owned();
    }
    let help = match cause {
        Cause::Redundant => {
            "Its pieces cost more than tiles: they share no samples, or fill no packets.\n\
             A strategy with larger pieces helps; for tiles a larger --tile."
        }
        Cause::Slowdown => {
            "The same pieces take longer when all threads compute: cores share memory, clock or\n\
             execution units, or other programs run. No strategy helps; fewer threads or a quieter \
             machine may."
        }
        Cause::Dispatch => "There are many pieces with little work in each. Larger pieces help.",
        Cause::Contention => {
            "Threads delay each other between pieces.\n\
             Writing without a lock helps, or taking the lock for larger pieces."
        }
        Cause::Imbalance => {
            "Threads wait for the last one.\n\
             Scheduling at run time helps, and smaller pieces at the end."
        }
        Cause::Serial => {
            "Starting and ending take long compared with the work.\n\
             A larger image helps, or threads that stay alive between renderings."
        }
    };
    format!("Largest loss: {} ({:.0} %). {help}", name(cause), 100.0 * share)
}

/// Returns the meaning of the rows.
fn legend(explanation: &Explanation) -> Vec<String> {
    let Explanation { reference, cost, .. } = explanation;
    vec![
        format!(
            "useful work: time of {reference}. redundant work: pieces on one thread take this much \
             longer."
        ),
        "slowdown: pieces take this much longer on all threads. dispatch: time between pieces on \
         one thread."
            .to_owned(),
        "contention: that time is this much longer on all threads. imbalance: waiting for the last \
         piece."
            .to_owned(),
        "serial part: before a thread's first piece and after the last piece of all.".to_owned(),
        "speed-up (last column): how much each part adds to or takes from the speed-up.".to_owned(),
        format!(
            "Recording takes {:.0} ns in each piece and {:.0} ns between pieces. The causes \
             exclude it;\nthe table of threads, from the quickest recorded rendering, includes it.",
            cost.inside_ns, cost.outside_ns
        ),
    ]
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// The unit of times. It is the same for all strategies, so that they can be compared.
#[derive(Clone, Copy)]
struct Unit {
    name: &'static str,
    ns: f64,
    decimals: usize,
}

/// If the shortest rendering takes less, times are in microseconds.
const SHORT_NS: f64 = 10e6;

impl Unit {
    /// Chooses the unit by the shortest rendering.
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
