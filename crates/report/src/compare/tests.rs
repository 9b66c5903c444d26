//! The three forms of one made-up comparison: a reference, its control, a pool, a queue that drew a
//! wrong picture, and one whose threads could not be started. And of two that were measured
//! together.

use super::*;
use rayweave_contract::{Digest, Granularity, Image, Output, Policy, Scheduling};
use rayweave_measure::Interval;
use rayweave_measure::compare::{Figures, OneShot, Rays, Role, Sample};
use std::time::Duration;

pub(super) fn digest(brightness: f32) -> Digest {
    Image::filled(1, 1, [brightness; 3]).expect("a pixel").digest()
}

/// Of 500 x 400 pixels: 4.38 each, of which 4 would have been enough.
pub(super) const RAYS: Rays = Rays { primary: 876_000, redundant: 76_000 };

/// The first rendering takes a quarter more, preparing included; two threads compute nearly all of
/// the time.
pub(super) fn sample(ns: u64) -> Sample {
    Sample {
        prepare_ns: 84_600,
        render_ns: ns,
        one_shot_ns: Some(ns / 4 * 5),
        cpu_ns: Some(ns / 10 * 19),
    }
}

pub(super) fn around(median: f64) -> Interval {
    Interval { median, low: median - 0.04, high: median + 0.06 }
}

pub(super) fn row(
    strategy: &'static str,
    threads: usize,
    role: Role,
    threads_start: Threads,
    ns: u64,
) -> Row {
    let speedup = 2e9 / ns as f64;
    Row {
        strategy,
        threads,
        role,
        threads_start,
        policy: Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::Dynamic { chunk: 1 },
            output: Output::InPlace,
        },
        identical: true,
        digest: Some(digest(1.0)),
        error: None,
        rays: Some(RAYS),
        samples: vec![sample(ns); 2],
        figures: Some(Figures {
            median_ns: ns as f64,
            prepare_ns: 84_600.0,
            one_shot: Some(OneShot {
                median_ns: 1.25 * ns as f64,
                speedup: around(1.6e9 / ns as f64),
            }),
            cpu_ns: Some(1.9 * ns as f64),
            speedup: around(speedup),
            efficiency: speedup / threads as f64,
            serial_fraction: (threads > 1).then_some(0.0256),
        }),
    }
}

pub(super) fn comparison() -> Comparison {
    let mut wrong = row("queue", 2, Role::Contender, Threads::PerRender, 1_000_000_000);
    wrong.identical = false;
    wrong.digest = Some(digest(0.5));
    wrong.figures = None;
    let mut failed = row("many, \"too\" many", 9000, Role::Contender, Threads::PerRender, 1);
    failed.digest = None;
    failed.identical = false;
    failed.figures = None;
    failed.samples.clear();
    failed.rays = None;
    failed.error = Some("cannot start 9000 threads".to_owned());
    let rows = vec![
        row("sequential", 1, Role::Reference, Threads::None, 2_000_000_000),
        row("sequential", 1, Role::Control, Threads::None, 2_010_000_000),
        row("pool", 2, Role::Contender, Threads::Pool, 1_025_641_026),
        wrong,
        failed,
    ];
    Comparison { rows, digest: digest(1.0), rounds: 2, seed: 1, goal: None, interrupted: false }
}

pub(super) fn machine() -> Machine {
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

/// 1 % of two cores for ten seconds.
pub(crate) fn noise() -> Noise {
    Noise {
        wall: Duration::from_secs(10),
        cores: 2,
        foreign: Some(Duration::from_millis(150)),
        stolen: Some(Duration::from_millis(50)),
        throttled: Some(0),
        involuntary_switches: Some(34),
        megahertz: Some(2400.0..=3600.0),
    }
}

pub(super) fn subject() -> Subject {
    Subject {
        scene: "room".to_owned(),
        width: 500,
        height: 400,
        tile: 32,
        antialiasing: 2,
        sampling: Sampling::Lattice,
        adaptive: false,
        formulas: Formulas::Robust,
        precision: "f32".to_owned(),
        lanes: 8,
        share_samples: true,
        search: Search::Auto,
    }
}

pub(super) fn with_report(
    comparison: &Comparison,
    read: impl FnOnce(&Report<'_>) -> String,
) -> String {
    read(&Report {
        subject: &subject(),
        comparison,
        machine: &machine(),
        noise: &noise(),
        baseline: None,
    })
}

/// With the digests called by what their pictures are.
pub(super) fn without_digests(text: &str) -> String {
    text.replace(&digest(1.0).short(), "RIGHT").replace(&digest(0.5).short(), "WRONG")
}

#[test]
fn table_as_a_whole() {
    let text = with_report(&comparison(), |report| report.table());
    let expected = r#"room, 500 x 400 pixels, antialiasing 2, f32, tiles of 32; 2 interleaved rounds, digest RIGHT

strategy              threads  median  one shot           speed-up  efficiency    serial           rays  threads        identical
                                   ms        ms    [95 % interval]              fraction                 start
──────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────
sequential                  1    2000      2500  1.00 [0.96, 1.06]       100 %         -  4.4/px +9.5 %  -              yes
sequential (control)        1    2010      2512  1.00 [0.96, 1.06]       100 %         -  4.4/px +9.5 %  -              yes
pool                        2    1026      1282  1.95 [1.91, 2.01]        97 %     0.026  4.4/px +9.5 %  before: 85 us  yes
queue                       2       -         -                  -           -         -  4.4/px +9.5 %  in the time    NO
many, "too" many         9000       -         -                  -           -         -              -  in the time    failed

queue, 2 threads: a wrong picture, digest WRONG, after 2 right ones
many, "too" many, 9000 threads: failed after 0 samples: cannot start 9000 threads
computed: 8 rays side by side, samples shared, search auto
median: of second renderings, each in a process of its own; threads started "before" are not in it.
one shot: preparing and the first rendering there, of a single picture. All pictures are verified untimed.
speed-up: time of sequential over the row's, median over the rounds. Serial fraction: Karp and Flatt.
rays: primary ones, counted in the warm-up; + those that the whole picture as a single tile would not need.
control: sequential over itself is 0.995 [0.955, 1.055]; 1 is in it, but it reaches 6 % from there.
Believe no difference between rows below 6 %: measure longer (--time-limit, --precision-goal), or on a quieter machine.
noise: others had 1.0 % of the machine; 0.1 s of it other machines on the same host; 34 involuntary switches; 2400 to 3600 MHz.
machine: A CPU, 8 logical cores, 2 available, quota 1.5 cores, linux x86_64
program: rustc 1.0, release build, commit 0123456789ab"#;
    assert_eq!(without_digests(&text), expected);
}

#[test]
fn table_is_plain_text() {
    let text = with_report(&comparison(), |report| report.table());
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
    assert!(text.lines().all(|line| line == line.trim_end()), "{text}");
    assert!(notes_fit(&text), "{text}");
}

/// Whether no line is longer than the one under the table's header.
pub(super) fn notes_fit(text: &str) -> bool {
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

/// Catches a disturbance that only the figures show, and a goal that is said to be met.
#[test]
fn what_is_to_be_doubted_is_told() {
    let line = |noise: &Noise| crate::noise::text(noise);
    let disturbed =
        Noise { foreign: Some(Duration::from_millis(4950)), throttled: Some(3), ..noise() };
    let told = "noise: others had 25.0 % of the machine; 0.1 s of it other machines on the same host; stopped 3 times \
                by the group's limit; 34 involuntary switches; 2400 to 3600 MHz.\nDISTURBED: measure again when the \
                machine is quiet.";
    assert_eq!(line(&disturbed), told);
    assert_eq!(line(&Noise::default()), "noise: this system does not tell.");

    let goal = |goal| with_report(&Comparison { goal, ..comparison() }, |report| report.table());
    assert!(!goal(None).contains("goal:"));
    assert!(goal(Some(0.06)).contains("goal: each speed-up is known to +-6.000 % or better."));
    // The half of 0.1 is 5 % of the reference's speed-up, a little more of its control's, and 2.6 %
    // of the pool's.
    assert!(
        goal(Some(0.04)).contains("goal: 2 speed-ups are not known to +-4.000 %: time was up.")
    );

    let stopped = Comparison { goal: Some(0.04), interrupted: true, ..comparison() };
    let text = with_report(&stopped, |report| report.table());
    assert!(text.contains("; interrupted after 2 interleaved rounds, digest "), "{text}");
    assert!(
        text.contains("goal: 2 speed-ups are not known to +-4.000 %: it was interrupted."),
        "{text}"
    );
    let json = with_report(&stopped, |report| report.json());
    assert!(json.contains("\"interrupted\": true"), "{json}");
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
    assert_eq!((&value["lanes"], &value["share_samples"]), (&8.into(), &true.into()));
    assert_eq!(value["search"], "auto");
    assert_eq!((&pool["primary_rays"], &pool["redundant_rays"]), (&876_000.into(), &76_000.into()));
    assert!(
        value["results"][4]["primary_rays"].is_null()
            && value["results"][4]["redundant_rays"].is_null()
    );
    assert_eq!((value.get("unshared"), value.get("sharing_speedup")), (None, None));
    let one_shot = &pool["one_shot"];
    assert_eq!(
        (&one_shot["median_ns"], &one_shot["samples_ns"][0]),
        (&1_282_051_283.into(), &1_282_051_280.into())
    );
    assert!((one_shot["speedup"]["median"].as_f64().expect("a number") - 1.56).abs() < 1e-9);
    assert_eq!(
        (&pool["cpu_ns"], pool["cpu_samples_ns"].as_array().map(Vec::len)),
        (&1_948_717_949.into(), Some(2))
    );
    let noise = &value["noise"];
    assert_eq!((&noise["wall_s"], &noise["foreign_cpu_s"]), (&10.0.into(), &0.15.into()));
    assert_eq!((&noise["share_of_others"], &noise["disturbed"]), (&0.01.into(), &false.into()));
    assert_eq!((&noise["throttled"], &noise["highest_mhz"]), (&0.into(), &3600.0.into()));
    assert_eq!(value["precision_goal"], serde_json::Value::Null);
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
    let records: Vec<::csv::StringRecord> =
        reader.records().map(|r| r.expect("a record")).collect();
    assert_eq!(records.len(), 5);
    assert_eq!(&records[2][column("median_ns")], "1025641026");
    assert_eq!(&records[2][column("serial_fraction")], "0.0256");
    assert_eq!(&records[1][column("control")], "true");
    assert_eq!(&records[3][column("identical")], "false");
    assert_eq!(&records[4][column("strategy")], "many, \"too\" many");
    assert_eq!(&records[4][column("speedup")], "");
    assert_eq!(&records[4][column("commit")], "0123456789ab");
    assert_eq!((&records[2][column("lanes")], &records[2][column("search")]), ("8", "auto"));
    assert_eq!(&records[2][column("share_samples")], "true");
    assert_eq!(
        (&records[2][column("primary_rays")], &records[2][column("redundant_rays")]),
        ("876000", "76000")
    );
    assert_eq!(&records[4][column("primary_rays")], "");
    // What older readers find by its place stays there.
    assert_eq!((column("scene"), column("commit"), column("lanes")), (0, 27, 28));
}

#[test]
fn rays_of_a_pixel_and_their_excess() {
    let cell = |primary, redundant| table::rays(&subject(), Rays { primary, redundant });
    assert_eq!(cell(876_000, 76_000), "4.4/px +9.5 %");
    assert_eq!(cell(5_000_000, 4_190_000), "25.0/px +517 %");
    assert_eq!(cell(5_000_000, 0), "25.0/px +0.0 %");
    assert_eq!(cell(0, 0), "0.0/px +0.0 %");
}

#[test]
fn how_it_was_computed() {
    let of = |change: &dyn Fn(&mut Subject)| {
        let mut subject = subject();
        change(&mut subject);
        table::computed(&subject)
    };
    assert_eq!(of(&|_| ()), "computed: 8 rays side by side, samples shared, search auto");
    assert_eq!(
        of(&|s| (s.lanes, s.share_samples, s.search) = (1, false, Search::Exhaustive)),
        "computed: rays one by one, samples not shared, search exhaustive"
    );
    let nothing = "computed: 8 rays side by side, no samples to share, search auto";
    assert_eq!(of(&|s| s.antialiasing = 0), nothing);
    let adaptive = "computed: 8 rays side by side, samples shared or interpolated, search auto";
    assert_eq!(of(&|s| (s.adaptive, s.share_samples) = (true, false)), adaptive);
    assert_eq!(of(&|s| (s.adaptive, s.antialiasing) = (true, 0)), nothing);
    assert_eq!(of(&|s| s.sampling = Sampling::Importance), nothing);
    assert!(
        of(&|s| s.formulas = Formulas::Textbook)
            .ends_with("search exhaustive, as the textbook's formulas need it")
    );
}
