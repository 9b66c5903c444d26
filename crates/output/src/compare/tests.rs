//! The forms of a made-up list, alone and beside itself without shared samples.

use super::fixtures::{
    around, digest, failed, machine, noise, record, records, results, row, subject,
};
use super::*;

/// Replaces the digests by the names of their images.
fn without_digests(text: &str) -> String {
    text.replace(&digest(1.0).short(), "RIGHT").replace(&digest(0.5).short(), "WRONG")
}

/// Returns the made-up list with and without shared samples. Without them the reference takes three
/// times as long, and the pool fails.
fn both() -> Results {
    let mut unshared = records();
    unshared.truncate(3);
    for Record { subject, measurement: row, .. } in &mut unshared {
        subject.share_samples = false;
        row.samples_ns.iter_mut().for_each(|ns| *ns *= 3);
        (row.primary_rays, row.redundant_rays) = (Some(5_000_000), Some(0));
        row.primary_packets = Some(625_000);
    }
    unshared[2].measurement = failed(unshared[2].measurement.clone(), "gone");
    Results::new(machine(), noise(), [records(), unshared].concat())
}

const TABLE: &str = include_str!("table.txt");

const UNSHARED: &str = include_str!("unshared_table.txt");

const LEGEND: &str = r#"
median: time of the second rendering in each process, without threads started "before".
cold: preparation and first rendering in each process. All images are verified, untimed.
speed-up: time of sequential over the row's, median over rounds. Serial fraction: Karp and Flatt.
rays: primary rays, counted in the warm-up; +: more than the image needs as a single tile.
lanes in use: share of the lanes that primary rays filled, counted in the warm-up.
"#;

const SHARING: &str =
    "sharing: without it sequential takes 3.00 [3.00, 3.00] times as long, in the same rounds.\n";

const MACHINE: &str = "noise: others used 1.0 % of the machine; \
other virtual machines on the host took 0.1 s of it; 34 involuntary context switches; 2400 to 3600 \
MHz.
machine: A CPU, 8 logical cores, 2 available, quota 1.5 cores, linux x86_64
program: rustc 1.0, release build, commit 0123456789ab";

#[test]
fn tables_as_a_whole() {
    let expected = format!("{TABLE}{LEGEND}{MACHINE}");
    assert_eq!(without_digests(&results().table(&[])), expected);
    let expected = format!("{TABLE}{UNSHARED}{LEGEND}{SHARING}{MACHINE}");
    assert_eq!(without_digests(&both().table(&[])), expected);
}

#[test]
fn table_is_plain_text() {
    let text = both().table(&[]);
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
    assert!(text.lines().all(|line| line == line.trim_end()), "{text}");
}

/// Catches a disturbance that only the figures show, and a goal that is wrongly reported as met.
#[test]
fn doubtful_figures_are_reported() {
    let disturbed =
        Noise { share_of_others: Some(0.25), throttled: Some(3), disturbed: true, ..noise() };
    let expected = "noise: others used 25.0 % of the machine; other virtual machines on \
                    the host took 0.1 s of it; the CPU quota stopped this program 3 times; 34 \
                    involuntary context switches; 2400 to 3600 MHz.\n\
                    DISTURBED: measure again when the machine is quiet.";
    assert_eq!(crate::noise::text(&disturbed), expected);
    assert_eq!(crate::noise::text(&Noise::default()), "noise: unknown on this system.");

    let goal = |goal, interrupted| {
        let mut results = results();
        results.precision_goal = goal;
        results.results.iter_mut().for_each(|record| record.interrupted = interrupted);
        results.table(&[])
    };
    assert!(!goal(None, false).contains("goal:"));
    let met = "goal: each speed-up is known to +-6.000 % or better.";
    assert!(goal(Some(0.06), false).contains(met));
    // Half of 0.1 is 5 % of the reference's speed-up, a little more of its control's, and 2.6 % of
    // the pool's.
    let missed = "goal: 2 speed-ups are not known to +-4.000 %: ";
    assert!(goal(Some(0.04), false).contains(&format!("{missed}the time limit was reached")));
    let text = goal(Some(0.04), true);
    assert!(text.contains("; interrupted after 2 interleaved rounds, digest "), "{text}");
    assert!(text.contains(&format!("{missed}the run was interrupted.")), "{text}");
}

#[test]
fn json_has_the_keys_that_stay() {
    let value = json::value(&both());
    let list = value["results"].as_array().expect("a list");
    assert_eq!((&value["schema"], list.len()), (&2.into(), 8));
    assert_eq!(
        (&value["machine"]["quota_cores"], &value["noise"]["throttled"]),
        (&1.5.into(), &0.into())
    );
    assert_eq!(
        value["sharing_speedup"],
        serde_json::json!({"median": 3.0, "low": 3.0, "high": 3.0})
    );
    let expected = r#"{
        "scene": "room", "width": 500, "height": 400, "antialiasing": 2, "sampling": "lattice",
        "adaptive": false, "formulas": "robust", "precision": "f32", "lanes": 8,
        "share_samples": true, "accel": "auto", "tile": 32,
        "rounds": 2, "interrupted": false, "disturbed": false,
        "reference_digest": "DIGEST", "imbalance": null, "largest_tile": null,
        "strategy": "pool", "threads": 2, "control": false, "granularity": "tile",
        "scheduling": "dynamic", "output": "in-place", "starts_threads": "pool",
        "identical": true, "digest": "DIGEST", "error": null,
        "median_ns": 1025641026, "speedup": SPEEDUP, "efficiency": 0.97499999965875,
        "serial_fraction": 0.0256, "prepare_ns": 84600,
        "cold_ns": 1282051280, "cold_speedup": COLD, "cpu_ns": 1948717938,
        "primary_rays": 876000, "redundant_rays": 76000, "primary_packets": 113000,
        "samples_ns": [1025641026, 1025641026], "prepare_samples_ns": [84600, 84600],
        "cold_samples_ns": [1282051280, 1282051280],
        "cpu_samples_ns": [1948717938, 1948717938]
    }"#;
    let expected = expected
        .replace("DIGEST", &digest(1.0).to_string())
        .replace("SPEEDUP", &json::text(&around(2e9 / 1_025_641_026.0)))
        .replace("COLD", &json::text(&around(1.6e9 / 1_025_641_026.0)));
    let expected: serde_json::Value = serde_json::from_str(&expected).expect("JSON");
    assert_eq!(list[2], expected);
    let (wrong, many) = (&list[3], &list[4]);
    assert_eq!(
        (&wrong["identical"], &wrong["digest"]),
        (&false.into(), &digest(0.5).to_string().into())
    );
    assert!(wrong["median_ns"].is_null() && wrong["speedup"].is_null() && wrong["error"].is_null());
    assert_eq!(
        (&many["error"], &many["digest"]),
        (&"cannot start 9000 threads".into(), &serde_json::Value::Null)
    );
    assert_eq!(many["samples_ns"], serde_json::json!([]));
    assert_eq!((&list[1]["control"], &list[5]["share_samples"]), (&true.into(), &false.into()));
}

/// Catches a key that is written and not read back.
#[test]
fn what_is_written_is_read() {
    let mut written = both().compared_with(&both());
    (written.seed, written.precision_goal) = (7, Some(0.01));
    written.not_measured = vec!["later.toml".to_owned()];
    let read = Results::parse(&written.json()).expect("a list");
    assert_eq!(json::value(&read), json::value(&written));
}

/// Catches a part of a list in the previous schema that gets lost.
#[test]
fn the_previous_schema_is_read() {
    let then = r#"{
        "schema": 1, "scene": "room", "width": 500, "height": 400, "antialiasing": 2,
        "sampling": "lattice", "adaptive": false, "formulas": "robust", "precision": "f32",
        "lanes": 8, "share_samples": true, "search": "auto", "tile": 32, "rounds": 2,
        "interrupted": true, "seed": 1, "digest": "DIGEST", "machine": MACHINE,
        "precision_goal": 0.01, "noise": NOISE,
        "results": [{
            "strategy": "pool", "threads": 2, "control": false, "identical": true,
            "digest": "DIGEST", "median_ns": 1025641026, "samples_ns": [1025641026, 1025641026],
            "speedup": SPEEDUP, "efficiency": 0.975, "serial_fraction": 0.0256,
            "threads_start": "prepare", "prepare_ns": 84600, "prepare_samples_ns": [84600, 84600],
            "error": null, "primary_rays": 876000, "redundant_rays": 76000,
            "one_shot": {"median_ns": 9, "samples_ns": [9, 9], "speedup": SPEEDUP},
            "cpu_ns": null, "cpu_samples_ns": null
        }]
    }"#;
    let speedup = Interval { median: 1.95, low: 1.91, high: 2.01 };
    let then = then
        .replace("DIGEST", &digest(1.0).to_string())
        .replace("SPEEDUP", &json::text(&speedup))
        .replace("MACHINE", &json::text(&machine()))
        .replace("NOISE", &json::text(&noise()));
    let pool = Measurement {
        granularity: String::new(),
        scheduling: String::new(),
        output: String::new(),
        speedup: Some(speedup),
        efficiency: Some(0.975),
        cold_ns: Some(9),
        cold_samples_ns: vec![9; 2],
        cold_speedup: Some(speedup),
        cpu_ns: None,
        cpu_samples_ns: Vec::new(),
        primary_packets: None,
        ..row("pool", 2, "pool", 1_025_641_026)
    };
    let read = Results::parse(&then).expect("a list");
    let expected = vec![Record { interrupted: true, ..record(pool) }];
    assert_eq!((read.results, read.seed, read.noise), (expected, 1, noise()));
    assert_eq!(read.precision_goal, Some(0.01));

    // The first lists had fewer keys.
    let early = then.replace("\"interrupted\": true,", "").replace("\"seed\": 1,", "");
    assert!(!Results::parse(&early).expect("a list").results[0].interrupted);
    let unknown = Results::parse(&then.replace("\"search\": \"auto\",", ""));
    assert!(unknown.is_err_and(|e| e.ends_with("missing field `search`")));

    let unshared = then.replace("\"share_samples\": true", "\"share_samples\": false");
    let shared = then.trim_end().trim_end_matches('}');
    let sharing = |list: &Results| {
        list.results.iter().map(|record| record.subject.share_samples).collect::<Vec<_>>()
    };
    let both = json::text(&speedup);
    let both = format!("{shared}, \"sharing_speedup\": {both}, \"unshared\": {unshared}}}");
    let both = Results::parse(&both).expect("a list");
    assert_eq!((sharing(&both), both.sharing_speedup), (vec![true, false], Some(speedup)));
    let scenes =
        format!(r#"{{"schema": 1, "comparisons": [{unshared}, {then}], "not_measured": ["x"]}}"#);
    let scenes = Results::parse(&scenes).expect("a list");
    assert_eq!((sharing(&scenes), scenes.not_measured), (vec![false, true], vec!["x".to_owned()]));
}

#[test]
fn csv_has_a_line_for_each_record() {
    let text = both().csv();
    let mut reader = ::csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().expect("headers").clone();
    let column = |name| headers.iter().position(|header| header == name).expect(name);
    let records: Vec<::csv::StringRecord> =
        reader.records().map(|r| r.expect("a record")).collect();
    assert_eq!(records.len(), 8);
    for (line, name, cell) in [
        (2, "median_ns", "1025641026"),
        (2, "serial_fraction", "0.0256"),
        (1, "control", "true"),
        (3, "identical", "false"),
        (4, "strategy", "many, \"too\" many"),
        (4, "speedup", ""),
        (4, "speedup_low", ""),
        (4, "commit", "0123456789ab"),
        (2, "accel", "auto"),
        (2, "samples", "2"),
        (2, "primary_rays", "876000"),
        (4, "primary_rays", ""),
        (5, "share_samples", "false"),
    ] {
        assert_eq!(&records[line][column(name)], cell, "{name} of line {line}");
    }
    assert_eq!(headers.iter().filter(|name| name.ends_with("samples_ns")).count(), 0);
}

#[test]
fn markdown_has_a_table_for_each_subject() {
    let text = without_digests(&both().markdown());
    assert_eq!(
        text.matches("| sequential | 1 | 2000 | 1.00 [0.96, 1.06] | 100 % | 2500 |").count(),
        2,
        "{text}"
    );
    assert!(text.contains("\n| pool | 2 | failed | | | |\n"), "{text}");
    assert!(text.contains("\n| queue | 2 | wrong image | | | |\n"), "{text}");
}

#[test]
fn without_a_reference_nothing_is_gained() {
    let mut list = both().results;
    list[5].measurement = failed(list[5].measurement.clone(), "gone");
    assert_eq!(Results::new(machine(), noise(), list).sharing_speedup, None);
    // Another image size is another subject, not the same without shared samples.
    let mut list = both().results;
    list[5..].iter_mut().for_each(|record| record.subject.width = 7);
    assert_eq!(Results::new(machine(), noise(), list).sharing_speedup, None);
}

#[test]
fn rays_of_a_pixel_and_their_excess() {
    let cell = |primary, redundant| table::rays_a_pixel(&subject(), primary, redundant);
    assert_eq!(cell(876_000, 76_000), "4.4/px +9.5 %");
    assert_eq!(cell(5_000_000, 4_190_000), "25.0/px +517 %");
    assert_eq!(cell(5_000_000, 0), "25.0/px +0.0 %");
    assert_eq!(cell(0, 0), "0.0/px +0.0 %");
}

#[test]
fn execution_in_words() {
    let of = |change: &dyn Fn(&mut Subject)| {
        let mut subject = subject();
        change(&mut subject);
        table::computed(&subject)
    };
    assert_eq!(of(&|_| ()), "computed: 8 rays side by side, samples shared, acceleration auto");
    assert_eq!(
        of(&|s| (s.lanes, s.share_samples, s.accel) = (1, false, "none".to_owned())),
        "computed: rays one by one, samples not shared, acceleration none"
    );
    let nothing = "computed: 8 rays side by side, no samples to share, acceleration auto";
    assert_eq!(of(&|s| s.antialiasing = 0), nothing);
    let adaptive =
        "computed: 8 rays side by side, samples shared or interpolated, acceleration auto";
    assert_eq!(of(&|s| (s.adaptive, s.share_samples) = (true, false)), adaptive);
    assert_eq!(of(&|s| (s.adaptive, s.antialiasing) = (true, 0)), nothing);
    assert_eq!(of(&|s| s.sampling = "importance".to_owned()), nothing);
    let textbook = of(&|s| s.formulas = "textbook".to_owned());
    assert!(textbook.ends_with("acceleration none (the textbook formulas allow no other)"));
}
