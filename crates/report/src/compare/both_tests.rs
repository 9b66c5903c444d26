//! A comparison with shared samples beside the same one without.

use super::tests::{comparison, machine, noise, notes_fit, subject, with_report, without_digests};
use super::*;
use rayweave_measure::compare::Rays;

/// The same without samples shared: the reference takes three times as long, and the pool fails.
fn unshared() -> Comparison {
    let mut comparison = comparison();
    comparison.rows.truncate(3);
    for row in &mut comparison.rows {
        row.samples.iter_mut().for_each(|sample| sample.render_ns *= 3);
        row.rays = Some(Rays { primary: 5_000_000, redundant: 0 });
    }
    comparison.rows[2].error = Some("gone".to_owned());
    comparison.rows[2].figures = None;
    comparison
}

fn with_both(unshared: &Comparison, read: impl FnOnce(&BothReport<'_>) -> String) -> String {
    let (subject, machine, noise, shared) = (subject(), machine(), noise(), comparison());
    let other = Subject { share_samples: false, ..subject.clone() };
    read(&BothReport {
        shared: Report {
            subject: &subject,
            comparison: &shared,
            machine: &machine,
            noise: &noise,
            baseline: None,
        },
        unshared: Report {
            subject: &other,
            comparison: unshared,
            machine: &machine,
            noise: &noise,
            baseline: None,
        },
    })
}

#[test]
fn both_tables_as_a_whole() {
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
control: sequential over itself is 0.995 [0.955, 1.055]; 1 is in it, but it reaches 6 % from there.
Believe no difference between rows below 6 %: measure longer (--time-limit, --precision-goal), or on a quieter machine.

room, 500 x 400 pixels, antialiasing 2, f32, tiles of 32; 2 interleaved rounds, digest RIGHT

strategy              threads  median  one shot           speed-up  efficiency    serial            rays  threads  identical
                                   ms        ms    [95 % interval]              fraction                  start
─────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────
sequential                  1    2000      2500  1.00 [0.96, 1.06]       100 %         -  25.0/px +0.0 %  -        yes
sequential (control)        1    2010      2512  1.00 [0.96, 1.06]       100 %         -  25.0/px +0.0 %  -        yes
pool                        2       -         -                  -           -         -  25.0/px +0.0 %  -        failed

pool, 2 threads: failed after 2 samples: gone
computed: 8 rays side by side, samples not shared, search auto
control: sequential over itself is 0.995 [0.955, 1.055]; 1 is in it, but it reaches 6 % from there.
Believe no difference between rows below 6 %: measure longer (--time-limit, --precision-goal), or on a quieter machine.

median: of second renderings, each in a process of its own; threads started "before" are not in it.
one shot: preparing and the first rendering there, of a single picture. All pictures are verified untimed.
speed-up: time of sequential over the row's, median over the rounds. Serial fraction: Karp and Flatt.
rays: primary ones, counted in the warm-up; + those that the whole picture as a single tile would not need.
sharing: without it sequential takes 3.00 [3.00, 3.00] times as long; both tables are of the same rounds.
noise: others had 1.0 % of the machine; 0.1 s of it other machines on the same host; 34 involuntary switches; 2400 to 3600 MHz.
machine: A CPU, 8 logical cores, 2 available, quota 1.5 cores, linux x86_64
program: rustc 1.0, release build, commit 0123456789ab"#;
    let text = with_both(&unshared(), |report| report.table());
    assert_eq!(without_digests(&text), expected);
    assert!(notes_fit(&text), "{text}");
}

#[test]
fn without_a_reference_nothing_is_gained() {
    let mut unshared = unshared();
    unshared.rows[0].figures = None;
    let text = with_both(&unshared, |report| report.table());
    assert!(!text.contains("sharing:"), "{text}");
    let text = with_both(&unshared, |report| report.json());
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(value.get("sharing_speedup"), Some(&serde_json::Value::Null));
}

#[test]
fn json_of_both_is_that_of_the_shared_with_the_other_in_it() {
    let parse = |text: &str| serde_json::from_str::<serde_json::Value>(text).expect("JSON");
    let mut both = parse(&with_both(&unshared(), |report| report.json()));
    let keys = both.as_object_mut().expect("an object");
    let other = keys.remove("unshared").expect("the other");
    assert_eq!(
        keys.remove("sharing_speedup"),
        Some(serde_json::json!({ "median": 3.0, "low": 3.0, "high": 3.0 }))
    );
    assert_eq!(both, parse(&with_report(&comparison(), |report| report.json())));

    let mut alone = parse(&with_report(&unshared(), |report| report.json()));
    alone["share_samples"] = false.into();
    assert_eq!(other, alone);
}

#[test]
fn csv_of_both_is_one_table() {
    let text = with_both(&unshared(), |report| report.csv());
    let alone = with_report(&comparison(), |report| report.csv());
    let rest = text.strip_prefix(&alone).expect("the lines with samples shared come first");
    assert_eq!(rest.lines().count(), 3);
    assert!(rest.lines().all(|line| line.contains(",8,false,auto,5000000,0,false,")), "{rest}");
}
