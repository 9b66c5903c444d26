//! Every form of a made-up time breakdown: a queue of tiles, and pixels by two of three threads.

use super::*;
use crate::compare::fixtures::noise;
use rayweave_contract::Rect;
use rayweave_measure::Interval;
use rayweave_measure::efficiency::{LostTime, TimeBreakdown};
use rayweave_measure::timeline::{self, Piece};
use serde_json::Value;
use std::collections::BTreeMap;

const MS: f64 = 1e6;

fn breakdown(threads: usize, [busy, between, waiting, serial]: [f64; 4]) -> TimeBreakdown {
    let wall_ns = (busy + between + waiting + serial) * MS / threads as f64;
    let [busy_ns, dispatch_ns, waiting_ns, serial_ns] =
        [busy, between, waiting, serial].map(|ms| ms * MS);
    TimeBreakdown { threads, wall_ns, busy_ns, dispatch_ns, waiting_ns, serial_ns }
}

fn piece((x, y, width, height): (u32, u32, u32, u32), begin_ns: u64, end_ns: u64) -> Piece {
    Piece { rect: Rect { x, y, width, height }, begin_ns, end_ns }
}

fn row(
    strategy: &'static str,
    threads: usize,
    together: TimeBreakdown,
    lanes: Vec<TimelineLane>,
) -> ExplainedStrategy {
    let (sequential, alone) =
        (breakdown(1, [98.0, 1.0, 0.0, 1.0]), breakdown(1, [100.0, 1.5, 0.0, 1.0]));
    ExplainedStrategy {
        strategy,
        threads,
        wall_ns: 60.0 * MS,
        lost_ns: threads as f64 * 60.0 * MS - 100.0 * MS,
        lost_time: LostTime::new(&sequential, &alone, &together),
        recorded: Interval { median: 1.01, low: 0.99, high: 1.02 },
        long_gap_ns: 1500.0,
        timeline: Timeline { wall_ns: 10_000, lanes },
    }
}

fn explanation() -> Explanation {
    let named = |name: &str, pieces| TimelineLane { name: Some(name.to_owned()), pieces };
    let queue = vec![
        named("queue 0", vec![piece((0, 0, 4, 2), 1000, 5000), piece((0, 2, 4, 2), 5010, 9000)]),
        named("queue 1", vec![piece((4, 0, 4, 2), 1500, 3000), piece((4, 2, 4, 2), 5000, 6000)]),
    ];
    let pixels = vec![
        TimelineLane {
            name: None,
            pieces: (0..8)
                .map(|x| piece((x, 0, 1, 1), 500 * u64::from(x), 500 * u64::from(x) + 400))
                .collect(),
        },
        TimelineLane { name: None, pieces: vec![piece((0, 1, 1, 1), 5, 1005)] },
    ];
    Explanation {
        reference: "sequential",
        reference_ns: 100.0 * MS,
        rows: vec![
            row("queue", 2, breakdown(2, [101.0, 2.0, 10.0, 5.8]), queue),
            row("by-pixel", 3, breakdown(3, [101.0, 2.0, 70.0, 5.0]), pixels),
        ],
        digest: Image::new(1, 1).expect("a pixel").digest(),
        rounds: 7,
        cost: timeline::RecordingCost { inside_ns: 30.4, outside_ns: 50.6 },
    }
}

fn with_view<T>(read: impl FnOnce(&ExplanationView<'_>) -> T) -> T {
    let rays = |rect: Rect| Some(u64::from(rect.width * rect.height) + 1);
    with_view_of(&explanation(), &rays, read)
}

/// Returns the text of an explanation whose rays are not counted.
fn text_of(explanation: &Explanation) -> String {
    with_view_of(explanation, &|_| None, |view| view.text())
}

fn with_view_of<T>(
    explanation: &Explanation,
    rays: &RayCost<'_>,
    read: impl FnOnce(&ExplanationView<'_>) -> T,
) -> T {
    let (size, machine, noise) = ((8, 4), &Machine::here(), &noise());
    read(&ExplanationView { scene: "room", size, tile: 4, explanation, rays, machine, noise })
}

#[test]
fn text_puts_a_figure_to_each_cause_and_adds_them_up() {
    let text = with_view(|view| view.text());
    let lines: Vec<Vec<&str>> =
        text.lines().map(|line| line.split_whitespace().collect()).collect();
    let has = |expected: &str| {
        let expected: Vec<&str> = expected.split_whitespace().collect();
        assert!(lines.contains(&expected), "{expected:?} in\n{text}");
    };
    assert!(text.starts_with(
        "queue on 2 threads: 60.00 ms, sequential 100.00 ms: speed-up 1.67, efficiency 83 %; \
         the quickest of 7 rounds\n"
    ));
    has("useful work 100.00 83.3 % +1.67");
    has("redundant work 2.00 1.7 % -0.03");
    has("slowdown 1.00 0.8 % -0.02");
    has("dispatch 0.50 0.4 % -0.01");
    has("contention 0.50 0.4 % -0.01");
    has("imbalance 10.00 8.3 % -0.17");
    has("serial part 4.80 4.0 % -0.08");
    has("not explained 1.20 1.0 % -0.02");
    has("explained: 18.80 of 20.00 ms lost (94 %)");
    has("queue 0 0.00 0.01 0.00 0.00 2 16 18 0 0.00");
    has("queue 1 0.00 0.00 0.00 0.01 2 16 18 1 0.00");
    assert!(text.contains("computes 1.52 times the mean.\nlong gaps: over 1.5 us "), "{text}");
    assert!(text.contains("\nLargest loss: imbalance (8 %). "), "{text}");
    has("1 more thread got no piece");
    has(&crate::noise::text(&noise()));
    has("Recording takes 30 ns in each piece and 51 ns between pieces. The causes exclude it;");
}

/// Catches a cause that is named by chance: the unexplained time, of either sign, exceeds it.
#[test]
fn what_chance_outweighs_is_no_verdict() {
    for (lost_ms, verdict) in [(28.7, true), (28.9, false), (8.9, true), (8.7, false)] {
        let mut explanation = explanation();
        // The causes take 18.8 ms, and the largest of them takes 10.
        explanation.rows[0].lost_ns = lost_ms * MS;
        let text = text_of(&explanation);
        assert_eq!(text.contains("\nLargest loss: imbalance (8 %). "), verdict, "{text}");
        assert_eq!(text.contains("\nNo verdict: "), !verdict, "{text}");
    }
}

/// Catches times that round to zero, and strategies shown in different units.
#[test]
fn short_renderings_are_told_in_microseconds() {
    let mut explanation = explanation();
    explanation.rows[1].wall_ns = 10.0 * MS;
    assert!(
        text_of(&explanation).contains("by-pixel on 3 threads: 10.00 ms, sequential 100.00 ms: ")
    );
    explanation.rows[1].wall_ns = 0.0623 * MS;
    let text = text_of(&explanation);
    assert!(text.contains("by-pixel on 3 threads: 62.3 us, sequential 100000.0 us: "), "{text}");
    assert!(text.contains("explained: 18800.0 of 20000.0 us lost (94 %)"), "{text}");
    let words: Vec<&str> = text.split_whitespace().collect();
    assert!(!words.contains(&"ms"), "{text}");
    let queue: Vec<&str> = "queue 1 1.5 2.5 2.0 5.5 2 16 - 1 2.0".split(' ').collect();
    assert!(words.windows(queue.len()).any(|window| window == queue), "{text}");
}

/// Catches a percentage of almost nothing, and advice where there is nothing to gain.
#[test]
fn little_lost_is_said_to_be_little() {
    let mut explanation = explanation();
    let mut row = row("queue", 1, breakdown(1, [100.2, 1.0, 0.0, 1.0]), Vec::new());
    (row.wall_ns, row.lost_ns) = (100.5 * MS, 0.5 * MS);
    row.lost_time = LostTime::new(
        &breakdown(1, [100.0, 1.0, 0.0, 1.0]),
        &breakdown(1, [100.2, 1.0, 0.0, 1.0]),
        &breakdown(1, [100.2, 1.0, 0.0, 1.0]),
    );
    explanation.rows = vec![row];
    let text = text_of(&explanation);
    assert!(text.starts_with("queue on 1 thread: "), "{text}");
    assert!(
        text.contains("explained: 0.20 of 0.50 ms lost (less than 1 % of the thread-time)\n"),
        "{text}"
    );
    assert!(text.contains("\nNo cause takes 1 % of the thread-time.\n"), "{text}");
}

#[test]
fn json_has_every_cause_and_thread() {
    let value: Value = serde_json::from_str(&with_view(|view| view.json())).expect("JSON");
    assert_eq!(
        (&value["schema"], &value["scene"], &value["rounds"]),
        (&1.into(), &"room".into(), &7.into())
    );
    assert_eq!(
        (&value["noise"]["wall_s"], &value["noise"]["disturbed"]),
        (&10.0.into(), &false.into())
    );
    let result = &value["results"][0];
    assert_eq!((&result["strategy"], &result["threads"]), (&"queue".into(), &2.into()));
    assert_eq!(result["speedup"], 100.0 / 60.0);
    let causes = ["redundant", "slowdown", "dispatch", "contention", "imbalance", "serial"];
    let losses = causes.map(|cause| result["losses_ns"][cause].as_f64().expect("a number").round());
    assert_eq!(losses, [2.0, 1.0, 0.5, 0.5, 10.0, 4.8].map(|ms| ms * MS));
    let thread = &result["threads_recorded"][1];
    let keys = [
        "begin_ns",
        "end_ns",
        "busy_ns",
        "between_ns",
        "idle_ns",
        "pieces",
        "pixels",
        "primary_rays",
    ];
    let figures = keys.map(|key| thread[key].as_u64().expect("a number"));
    assert_eq!(figures, [1500, 6000, 2500, 2000, 5500, 2, 16, 18]);
    assert_eq!((&thread["long_gaps"], &thread["long_gaps_ns"]), (&1.into(), &2000.into()));
}

/// The rules of the format: each event has its phase, process, thread and time; a slice has a
/// duration; slices of one thread do not overlap; processes and threads have names.
#[test]
fn the_trace_keeps_the_rules_of_its_format() {
    let text = with_view(|view| view.trace());
    let trace: Value = serde_json::from_str(&text).expect("JSON");
    let events = trace["traceEvents"].as_array().expect("a list");
    let mut slices: BTreeMap<(u64, u64), Vec<(f64, f64)>> = BTreeMap::new();
    let mut names: BTreeMap<(u64, u64), Vec<(&str, &str)>> = BTreeMap::new();
    for event in events {
        let id = |key: &str| event[key].as_u64().unwrap_or_else(|| panic!("{key}: {event}"));
        let thread = (id("pid"), id("tid"));
        let begin = event["ts"].as_f64().expect("a time");
        let name = event["name"].as_str().expect("a name");
        match event["ph"].as_str().expect("a phase") {
            "X" => {
                let duration = event["dur"].as_f64().expect("a duration");
                assert!(begin >= 0.0 && duration >= 0.0, "{event}");
                slices.entry(thread).or_default().push((begin, begin + duration));
            }
            "M" => {
                let given = event["args"]["name"].as_str().expect("a name");
                names.entry(thread).or_default().push((name, given));
            }
            other => panic!("{other}: {event}"),
        }
    }
    for (thread, slices) in &mut slices {
        slices.sort_by(|a, b| a.0.total_cmp(&b.0));
        // In microseconds, 1e-9 is rounding.
        assert!(
            slices.windows(2).all(|pair| pair[0].1 <= pair[1].0 + 1e-9),
            "{thread:?}: {slices:?}"
        );
        assert!(names[thread].iter().any(|(kind, _)| *kind == "thread_name"), "{thread:?}");
    }
    assert_eq!(names[&(1, 0)], [("process_name", "queue"), ("thread_name", "rendering")]);
    assert_eq!(names[&(1, 2)], [("thread_name", "queue 1")]);
    assert_eq!(names[&(2, 2)], [("thread_name", "thread 1")]);
    assert_eq!(slices[&(1, 2)], [(1.5, 3.0), (5.0, 6.0)]);

    // Eight pixels in a row are a single slice.
    assert_eq!(slices[&(2, 1)], [(0.0, 3.9)]);
    let run = events.iter().find(|event| event["name"] == "pixels").expect("a run");
    let keys = ["x", "y", "width", "height", "pixels", "pieces"];
    assert_eq!(keys.map(|key| run["args"][key].as_u64()), [0, 0, 8, 1, 8, 8].map(Some));
    assert_eq!(run["args"]["busy_us"], 3.2);
}

#[test]
fn the_time_line_has_a_bar_for_each_thread_and_a_name() {
    let [queue, pixels] = with_view(|view| {
        [0, 1].map(|place| view.timeline(&view.explanation.rows[place]).expect("drawn"))
    });
    for part in
        ["queue 0: computes 79.9 % of the time", "queue 1: computes 25.0 % of the time", "ms since"]
    {
        assert!(queue.contains(part), "{part}: {queue}");
    }
    // The background, the idle bars of two threads and four pieces.
    assert_eq!(queue.matches("<rect").count(), 1 + 2 + 4, "{queue}");
    assert!(pixels.contains("thread 2: no piece"), "{pixels}");
    assert_eq!(pixels.matches("<rect").count(), 1 + 3 + 2, "{pixels}");
}

#[test]
fn the_map_of_cost_has_each_piece_and_a_scale() {
    let map = with_view(|view| view.cost(&view.explanation.rows[0]).expect("drawn"));
    assert_eq!(map.matches("<rect").count(), 1 + 4 + 64, "{map}");
    assert!(map.contains("us a pixel") && map.contains("queue: time of each pixel"), "{map}");
}
