//! The three forms of one made-up comparison: a reference, its control, a pool, a queue that drew a
//! wrong picture, and one whose threads could not be started.

use super::*;
use rayweave_core::{Digest, Image};
use rayweave_measure::Interval;
use rayweave_measure::compare::{Figures, Role, Sample};

fn digest(brightness: f32) -> Digest {
    Image::filled(1, 1, [brightness; 3]).expect("a pixel").digest()
}

fn row(strategy: &'static str, threads: usize, role: Role, threads_start: ThreadsStart, ns: u64) -> Row {
    let speedup = 2e9 / ns as f64;
    Row {
        strategy,
        threads,
        role,
        threads_start,
        identical: true,
        digest: Some(digest(1.0)),
        error: None,
        samples: vec![Sample { prepare_ns: 84_600, render_ns: ns }; 2],
        figures: Some(Figures {
            median_ns: ns as f64,
            prepare_ns: 84_600.0,
            speedup: Interval { median: speedup, low: speedup - 0.04, high: speedup + 0.06 },
            efficiency: speedup / threads as f64,
            serial_fraction: (threads > 1).then_some(0.0256),
        }),
    }
}

fn comparison() -> Comparison {
    let mut wrong = row("queue", 2, Role::Contender, ThreadsStart::Render, 1_000_000_000);
    wrong.identical = false;
    wrong.digest = Some(digest(0.5));
    wrong.figures = None;
    let mut failed = row("many, \"too\" many", 9000, Role::Contender, ThreadsStart::Render, 1);
    failed.digest = None;
    failed.identical = false;
    failed.figures = None;
    failed.samples.clear();
    failed.error = Some("cannot start 9000 threads".to_owned());
    let rows = vec![
        row("sequential", 1, Role::Reference, ThreadsStart::Never, 2_000_000_000),
        row("sequential", 1, Role::Control, ThreadsStart::Never, 2_010_000_000),
        row("pool", 2, Role::Contender, ThreadsStart::Prepare, 1_025_641_026),
        wrong,
        failed,
    ];
    Comparison { rows, digest: digest(1.0), rounds: 2, seed: 1 }
}

fn machine() -> Machine {
    Machine {
        cpu: "A CPU".to_owned(),
        logical_cores: 8,
        available_threads: 2,
        quota: Some(1.5),
        os: "linux",
        arch: "x86_64",
        target_features: vec!["sse2"],
        compiler: "rustc 1.0",
        profile: "release",
        commit: "0123456789ab",
    }
}

fn with_report(comparison: &Comparison, read: impl FnOnce(&Report<'_>) -> String) -> String {
    let subject = Subject {
        scene: "room".to_owned(),
        width: 500,
        height: 400,
        tile: 32,
        antialiasing: 2,
        sampling: Sampling::Lattice,
        formulas: Formulas::Robust,
        precision: "f32".to_owned(),
    };
    read(&Report { subject: &subject, comparison, machine: &machine() })
}

#[test]
fn table_as_a_whole() {
    let text = with_report(&comparison(), |report| report.table());
    let expected = r#"room, 500 x 400 pixels, antialiasing 2, f32, tiles of 32; 2 interleaved rounds, digest RIGHT

strategy              threads  median           speed-up  efficiency    serial  threads        identical
                                   ms    [95 % interval]              fraction  start
─────────────────────────────────────────────────────────────────────────────────────────────────────────
sequential                  1    2000  1.00 [0.96, 1.06]       100 %         -  -              yes
sequential (control)        1    2010  1.00 [0.96, 1.06]       100 %         -  -              yes
pool                        2    1026  1.95 [1.91, 2.01]        97 %     0.026  before: 85 us  yes
queue                       2       -                  -           -         -  in the time    NO
many, "too" many         9000       -                  -           -         -  in the time    failed

queue, 2 threads: a wrong picture, digest WRONG, after 2 right ones
many, "too" many, 9000 threads: failed after 0 samples: cannot start 9000 threads
time: rendering alone, each picture verified outside of it; threads started "before" it are not in it.
speed-up: time of sequential over the row's, median over the rounds. Serial fraction: Karp and Flatt.
control: sequential over itself is 0.995 [0.955, 1.055]; as it should be, 1 is in it.
That much is order and drift, of one thread; to tell rows apart compare their own intervals.
machine: A CPU, 8 logical cores, 2 available, quota 1.5 cores, linux x86_64
program: rustc 1.0, release build, commit 0123456789ab"#;
    let text = text.replace(&digest(1.0).short(), "RIGHT").replace(&digest(0.5).short(), "WRONG");
    assert_eq!(text, expected);
}

#[test]
fn table_is_plain_text() {
    let text = with_report(&comparison(), |report| report.table());
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
    assert!(text.lines().all(|line| line == line.trim_end()), "{text}");
    assert!(notes_fit(&text), "{text}");
}

/// Whether no line is longer than the one under the table's header.
fn notes_fit(text: &str) -> bool {
    let width = |line: &str| line.chars().count();
    let rule = text.lines().find(|line| line.starts_with('─')).map_or(0, width);
    text.lines().all(|line| width(line) <= rule)
}

#[test]
fn a_control_that_differs_from_itself_is_told() {
    let mut comparison = comparison();
    let figures = comparison.rows[1].figures.as_mut().expect("figures");
    figures.speedup = Interval { median: 0.9, low: 0.85, high: 0.95 };
    let text = with_report(&comparison, |report| report.table());
    assert!(text.contains("0.900 [0.850, 0.950]; 1 is not in it"), "{text}");
    assert!(notes_fit(&text), "{text}");
}

#[test]
fn json_has_the_keys_that_stay() {
    let text = with_report(&comparison(), |report| report.json());
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(value["schema"], 1);
    assert_eq!(
        (&value["scene"], &value["width"], &value["height"]),
        (&"room".into(), &500.into(), &400.into())
    );
    assert_eq!(value["machine"]["quota_cores"], 1.5);
    let pool = &value["results"][2];
    assert_eq!((&pool["strategy"], &pool["threads"]), (&"pool".into(), &2.into()));
    assert_eq!((&pool["identical"], &pool["control"]), (&true.into(), &false.into()));
    assert_eq!(pool["digest"], digest(1.0).to_string());
    assert_eq!(pool["median_ns"], 1_025_641_026);
    assert_eq!(pool["samples_ns"], serde_json::json!([1_025_641_026, 1_025_641_026]));
    let speedup = pool["speedup"].as_object().expect("an object");
    assert_eq!(speedup.keys().collect::<Vec<_>>(), ["high", "low", "median"]);
    assert!((speedup["median"].as_f64().expect("a number") - 1.95).abs() < 1e-9);
    assert_eq!((&pool["threads_start"], &pool["prepare_ns"]), (&"prepare".into(), &84_600.into()));
    assert_eq!(value["results"][1]["control"], true);
}

#[test]
fn json_of_rows_without_figures() {
    let text = with_report(&comparison(), |report| report.json());
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let (wrong, failed) = (&value["results"][3], &value["results"][4]);
    assert_eq!(wrong["identical"], false);
    assert_eq!(wrong["digest"], digest(0.5).to_string());
    assert!(wrong["median_ns"].is_null() && wrong["speedup"].is_null() && wrong["error"].is_null());
    assert_eq!(failed["error"], "cannot start 9000 threads");
    assert_eq!(failed["samples_ns"], serde_json::json!([]));
    assert!(failed["digest"].is_null());
}

#[test]
fn csv_has_a_line_for_each_row() {
    let text = with_report(&comparison(), |report| report.csv());
    let mut reader = ::csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().expect("headers").clone();
    let column = |name| headers.iter().position(|header| header == name).expect(name);
    let records: Vec<::csv::StringRecord> = reader.records().map(|r| r.expect("a record")).collect();
    assert_eq!(records.len(), 5);
    assert_eq!(&records[2][column("median_ns")], "1025641026");
    assert_eq!(&records[2][column("serial_fraction")], "0.0256");
    assert_eq!(&records[1][column("control")], "true");
    assert_eq!(&records[3][column("identical")], "false");
    assert_eq!(&records[4][column("strategy")], "many, \"too\" many");
    assert_eq!(&records[4][column("speedup")], "");
    assert_eq!(&records[4][column("commit")], "0123456789ab");
}
