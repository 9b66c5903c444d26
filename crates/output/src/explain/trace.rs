//! The time lines in the trace event format, which Perfetto and Chrome's tracing page show.
//!
//! A strategy is a process, and each of its threads is a thread. Thread 0 is the whole rendering.
//! Times are in microseconds since the rendering began. Source: Google, "Trace Event Format".

use super::{ExplanationView, label, runs};
use rayweave_measure::explanation::ExplainedStrategy;
use serde::Serialize;

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Trace<'a> {
    display_time_unit: &'static str,
    trace_events: Vec<Event<'a>>,
}

#[derive(Serialize)]
struct Event<'a> {
    name: &'a str,
    ph: Phase,
    pid: usize,
    tid: usize,
    ts: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    dur: Option<f64>,
    args: Arguments,
}

#[derive(Serialize)]
enum Phase {
    /// A slice with a duration.
    #[serde(rename = "X")]
    Complete,
    /// The name of a process or thread.
    #[serde(rename = "M")]
    Metadata,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Arguments {
    Name { name: String },
    Piece { x: u32, y: u32, width: u32, height: u32, pixels: u64, pieces: u64, busy_us: f64 },
    Whole { threads: usize },
}

pub(super) fn text(view: &ExplanationView<'_>) -> String {
    let rows = view.explanation.rows.iter().enumerate();
    let trace_events = rows.flat_map(|(index, row)| events(index + 1, row)).collect();
    let trace = Trace { display_time_unit: "ms", trace_events };
    // On one line: indented JSON would be three times as long.
    serde_json::to_string(&trace).expect("plain structures are JSON")
}

fn events(pid: usize, row: &ExplainedStrategy) -> Vec<Event<'_>> {
    let named = |kind, tid, name: String| Event {
        name: kind,
        ph: Phase::Metadata,
        pid,
        tid,
        ts: 0.0,
        dur: None,
        args: Arguments::Name { name },
    };
    let whole = Event {
        name: row.strategy,
        ph: Phase::Complete,
        pid,
        tid: 0,
        ts: 0.0,
        dur: Some(microseconds(row.timeline.wall_ns)),
        args: Arguments::Whole { threads: row.threads },
    };
    let mut events = vec![
        named("process_name", 0, row.strategy.to_owned()),
        named("thread_name", 0, "rendering".to_owned()),
        whole,
    ];
    for (index, lane) in row.timeline.lanes.iter().enumerate() {
        let tid = index + 1;
        events.push(named("thread_name", tid, label(lane.name.as_deref(), index)));
        events.extend(runs::of(lane, row.long_gap_ns).iter().map(|run| slice(pid, tid, run)));
    }
    events
}

fn slice(pid: usize, tid: usize, run: &runs::Run) -> Event<'static> {
    let runs::Run { rect, begin_ns, end_ns, busy_ns, pieces } = *run;
    Event {
        name: if pieces > 1 { "pixels" } else { "piece" },
        ph: Phase::Complete,
        pid,
        tid,
        ts: microseconds(begin_ns),
        dur: Some(microseconds(end_ns.saturating_sub(begin_ns))),
        args: Arguments::Piece {
            x: rect.x,
            y: rect.y,
            width: rect.width,
            height: rect.height,
            pixels: u64::from(rect.width) * u64::from(rect.height),
            pieces,
            busy_us: microseconds(busy_ns),
        },
    }
}

fn microseconds(ns: u64) -> f64 {
    ns as f64 / 1e3
}
