//! The changes from an earlier list of measurements to this one.

use super::{Record, Results, Subject, control, scene_file, scene_name};
use crate::{json, style};
use rayweave_measure::statistics::{LEAST_VALUES, median_ratio_interval, ratios};
use rayweave_measure::{Interval, Machine, Measurement};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The change of a strategy's time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// The scene's path as the later list has it.
    pub scene: String,
    /// True if samples were shared.
    pub share_samples: bool,
    /// The strategy's name.
    pub strategy: String,
    /// The number of computing threads.
    pub threads: usize,
    /// The time now over the time then; `None` if one of them is missing.
    pub time: Option<Interval>,
    /// The same for the time over the reference's time in the same run, so that a change of the
    /// whole machine cancels out.
    pub relative_time: Option<Interval>,
    /// "slower", "faster", "as before", "too few samples" or "not in both".
    pub verdict: String,
}

/// Checks whether times of `subjects` can be compared with those of `then`, before any is measured.
/// A scene may be in another folder.
///
/// # Errors
///
/// One of them was not measured then; the message names the settings that differ.
pub fn comparable(then: &Results, subjects: &[Subject]) -> Result<(), String> {
    let help =
        "use the same scene and options, or measure a new baseline with these (--json)".to_owned();
    for subject in subjects {
        let namesakes = subjects.iter().filter(|other| differences(other, subject).is_empty());
        let found = same_subject(then, subject);
        // One group cannot be the baseline of two scenes.
        let is_exact = found.is_some_and(|group| group[0].subject.scene == subject.scene);
        if is_exact || (found.is_some() && namesakes.count() == 1) {
            continue;
        }
        // The differences from the subject that is most like it.
        let differences = then.groups().map(|group| differences(&group[0].subject, subject));
        return Err(match differences.min_by_key(Vec::len) {
            None => format!("it has no results: {help}"),
            Some(none) if none.is_empty() => {
                let scene = &subject.scene;
                format!("more than one scene has the file name of {scene}: {help}")
            }
            Some(differences) => format!("{}: {help}", differences.join(", ")),
        });
    }
    Ok(())
}

/// Returns the records of the same subject: of the same path, or else of the one scene with the
/// same file name.
fn same_subject<'a>(then: &'a Results, subject: &Subject) -> Option<&'a [Record]> {
    let same = |group: &&[Record]| differences(&group[0].subject, subject).is_empty();
    let alike: Vec<&[Record]> = then.groups().filter(same).collect();
    let exact = alike.iter().find(|group| group[0].subject.scene == subject.scene);
    match (exact, &alike[..]) {
        (Some(exact), _) => Some(exact),
        (None, [one]) => Some(one),
        _ => None,
    }
}

fn differences(then: &Subject, now: &Subject) -> Vec<String> {
    let (then, now) = (json::value(then), json::value(now));
    let same = |key: &str, there: &Value, here: &Value| match (there.as_str(), here.as_str()) {
        (Some(there), Some(here)) if key == "scene" => scene_file(there) == scene_file(here),
        _ => there == here,
    };
    let keys = now.as_object().into_iter().flatten();
    keys.filter(|(key, here)| !same(key, &then[*key], here))
        .map(|(key, here)| format!("{key} was {} and is {here} now", then[key]))
        .collect()
}

impl Results {
    /// Adds the changes since `then` to the list: one for each record but the controls.
    #[must_use]
    pub fn compared_with(mut self, then: &Self) -> Self {
        let changes = self.groups().flat_map(|now| changes(then.same_group(now), now)).collect();
        self.changes = Some(changes);
        self.doubts = doubts(&self, then);
        self
    }

    /// Returns the records of the same subject in this list; none if there is no such subject.
    fn same_group(&self, now: &[Record]) -> &[Record] {
        same_subject(self, &now[0].subject).unwrap_or_default()
    }
}

fn changes(then: &[Record], now: &[Record]) -> Vec<Change> {
    let times = |record: &Record| match record.measurement.median_ns {
        Some(_) => record.measurement.samples_ns.clone(),
        None => Vec::new(),
    };
    let reference = |group: &[Record]| {
        group.first().map(|record| record.measurement.samples_ns.clone()).unwrap_or_default()
    };
    let (reference_now, reference_then) = (reference(now), reference(then));
    let change = |(place, record): (usize, &Record)| {
        let row = &record.measurement;
        let alike = |other: &Measurement| {
            (&other.strategy, other.threads, other.control) == (&row.strategy, row.threads, false)
        };
        let earlier = then.iter().find(|record| alike(&record.measurement)).map(times);
        let (now, then) = (times(record), earlier.unwrap_or_default());
        let samples = now.len().min(then.len());
        // Few samples have no interval, and times of 0 no ratio.
        let sound = |ratio: &Interval| {
            samples >= LEAST_VALUES && ratio.low.is_finite() && ratio.high.is_finite()
        };
        let time = median_ratio_interval(&floats(&now), &floats(&then)).filter(sound);
        let relative_time =
            median_ratio_interval(&ratios(&now, &reference_now), &ratios(&then, &reference_then))
                .filter(sound);
        // The reference's relative time is always 1, so its own time decides.
        let verdict = match verdict(if place == 0 { time } else { relative_time }) {
            "not in both" if (1..LEAST_VALUES).contains(&samples) => "too few samples",
            verdict => verdict,
        };
        Change {
            scene: record.subject.scene.clone(),
            share_samples: record.subject.share_samples,
            strategy: row.strategy.clone(),
            threads: row.threads,
            time,
            relative_time,
            verdict: verdict.to_owned(),
        }
    };
    now.iter().enumerate().filter(|(_, record)| !record.measurement.control).map(change).collect()
}

fn verdict(ratio: Option<Interval>) -> &'static str {
    match ratio {
        None => "not in both",
        Some(interval) if interval.contains(1.0) => "as before",
        Some(interval) if interval.low > 1.0 => "slower",
        Some(_) => "faster",
    }
}

fn floats(samples: &[u64]) -> Vec<f64> {
    samples.iter().map(|&ns| ns as f64).collect()
}

/// Returns the reasons to distrust the verdicts, one a line.
fn doubts(now: &Results, then: &Results) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(doubt) = doubt(now) {
        lines.push(format!("This run {doubt}: do not trust the verdicts, measure again."));
    }
    if let Some(doubt) = doubt(then) {
        lines.push(format!(
            "The baseline {doubt}: do not trust the verdicts, measure a new baseline."
        ));
    }
    let elsewhere = other_machine(&now.machine, &then.machine);
    if !elsewhere.is_empty() {
        lines.push(format!(
            "The baseline is of another machine or build: the verdicts compare these too.\n{}",
            elsewhere.join("\n")
        ));
    }
    let differs = |group: &[Record]| {
        let then = then.same_group(group).first();
        then.is_some_and(|then| then.reference_digest != group[0].reference_digest)
    };
    lines.extend(now.groups().filter(|group| differs(group)).map(|group| {
        let scene = scene_name(&group[0]);
        format!("The baseline is of ANOTHER IMAGE of {scene}, which may explain the difference.")
    }));
    lines
}

/// Returns the properties of machine and build that differ, but for the commit: comparing two
/// commits is what baselines are for.
fn other_machine(now: &Machine, then: &Machine) -> Vec<String> {
    let (now, then) = (json::value(now), json::value(then));
    let facts = now.as_object().into_iter().flatten();
    let differs = |(key, here): &(&String, &Value)| *key != "commit" && then[*key] != **here;
    facts
        .filter(differs)
        .map(|(key, here)| format!("{key} was {} and is {here} now", then[key]))
        .collect()
}

/// Returns the reason to doubt the times of a run, if there is one.
fn doubt(results: &Results) -> Option<String> {
    let disturbed =
        results.noise.disturbed || results.results.iter().any(|record| record.disturbed);
    let off = |group: &[Record]| control(group).is_some_and(|control| !control.contains(1.0));
    let causes = [
        disturbed.then_some("was disturbed"),
        results.groups().any(off).then_some("has a control whose interval does not contain 1"),
    ];
    let causes: Vec<&str> = causes.into_iter().flatten().collect();
    (!causes.is_empty()).then(|| causes.join(" and "))
}

const HEADER: [&str; 5] = [
    "strategy",
    "threads",
    "time now / then\n[95 % interval]",
    "the same, relative\nto the reference",
    "verdict",
];

/// The longest name of a strategy that the table shows whole.
const NAME: usize = 19;

/// Returns the table of changes, if there is an earlier list. `shown` is a ratio as text.
pub(super) fn text(results: &Results, shown: fn(Interval) -> String) -> Option<String> {
    let changes = results.changes.as_ref()?;
    let mut lines = vec![String::new(), "changes since the baseline".to_owned()];
    let groups =
        changes.chunk_by(|a, b| (&a.scene, a.share_samples) == (&b.scene, b.share_samples));
    let several = results.groups().count() > 1;
    for group in groups {
        let samples = if group[0].share_samples { "shared" } else { "not shared" };
        lines.push(String::new());
        lines.extend(several.then(|| format!("{}, samples {samples}", group[0].scene)));
        lines.push(style::table(HEADER, group.iter().map(|change| cells(change, shown)), 1..=3));
    }
    lines.push(
        "\nTwo runs also differ by drift, so the verdict uses the time relative to the\n\
         reference of the same run; for the reference itself it uses the time.\n\
         Expect one false alarm in twenty rows."
            .to_owned(),
    );
    lines.extend(results.doubts.iter().cloned());
    Some(lines.join("\n"))
}

fn cells(change: &Change, shown: fn(Interval) -> String) -> [String; HEADER.len()] {
    let cell = |interval: Option<Interval>| interval.map_or_else(|| "-".to_owned(), shown);
    [
        style::clipped(&change.strategy, NAME),
        change.threads.to_string(),
        cell(change.time),
        cell(change.relative_time),
        change.verdict.clone(),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{results, subject};
    use super::*;

    /// Returns the made-up list with a reference and control `reference` times as slow, and a pool
    /// `pool` times as slow.
    fn slowed(reference: f64, pool: f64) -> Results {
        let mut results = results();
        let noise = [0.99, 1.0, 1.01, 1.0, 0.995, 1.005, 1.0, 1.0];
        for (record, (ns, factor)) in
            results.results.iter_mut().zip([(2e9, reference), (2e9, reference), (1e9, pool)])
        {
            record.measurement.samples_ns =
                noise.map(|noise| (ns * factor * noise) as u64).to_vec();
        }
        results
    }

    /// Catches a slower machine reported as a slower strategy, and an inverted ratio.
    #[test]
    fn a_slower_machine_is_not_a_slower_strategy() {
        let then = slowed(1.0, 1.0);
        let expect = |now: Results, reference: &str, pool: &str| {
            let changes = now.compared_with(&then).changes.expect("changes");
            let verdicts: Vec<_> =
                changes.iter().map(|change| (&*change.strategy, &*change.verdict)).collect();
            let [queue, many] = [("queue", "not in both"), ("many, \"too\" many", "not in both")];
            assert_eq!(verdicts, [("sequential", reference), ("pool", pool), queue, many]);
        };
        expect(slowed(1.0, 1.0), "as before", "as before");
        expect(slowed(1.0, 1.1), "as before", "slower");
        expect(slowed(1.0, 0.9), "as before", "faster");
        expect(slowed(1.1, 1.1), "slower", "as before");
    }

    #[test]
    fn changes_for_people_and_programs() {
        let now = slowed(1.0, 1.1).compared_with(&slowed(1.0, 1.0));
        let text = now.table(&[]);
        let line = text.lines().find(|line| line.starts_with("pool") && line.ends_with("slower"));
        assert!(line.is_some_and(|line| line.contains("1.100 [1.0")), "{text}");
        assert!(!text.contains("ANOTHER IMAGE"), "{text}");
        let value: Value = serde_json::from_str(&now.json()).expect("JSON");
        let change = &value["changes"][1];
        assert_eq!((&change["strategy"], &change["verdict"]), (&"pool".into(), &"slower".into()));
        assert!(change["relative_time"]["low"].as_f64() > Some(1.0), "{change}");

        let mut then = slowed(1.0, 1.0);
        then.results[0].reference_digest = "another".to_owned();
        let told = slowed(1.0, 1.0).compared_with(&then).table(&[]);
        assert!(told.contains("ANOTHER IMAGE of room"), "{told}");
    }

    /// Catches a verdict from a run that is not to be trusted itself.
    #[test]
    fn doubtful_runs_are_reported() {
        let run = |drifted, disturbed| {
            let mut run = slowed(1.0, 1.0);
            run.noise.disturbed = disturbed;
            if drifted {
                let off = Interval { median: 0.9, low: 0.8, high: 0.99 };
                run.results[1].measurement.speedup = Some(off);
            }
            run
        };
        let told = |then: &Results, now: Results| {
            let text = now.compared_with(then).table(&[]);
            let lines = text.lines().filter(|line| line.contains("do not trust the verdicts"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        let good = || run(false, false);
        assert!(told(&good(), good()).is_empty(), "good runs are doubted");
        for (drifted, disturbed, why) in [
            (true, false, "has a control whose interval does not contain 1"),
            (false, true, "was disturbed"),
            (true, true, "was disturbed and has a control whose interval does not contain 1"),
        ] {
            let bad = || run(drifted, disturbed);
            let advice = "do not trust the verdicts, measure";
            let then = format!("The baseline {why}: {advice} a new baseline.");
            assert_eq!(told(&bad(), good()), [then]);
            let now = format!("This run {why}: {advice} again.");
            assert_eq!(told(&good(), bad()), [now]);
        }
    }

    /// Catches verdicts without a word on what else differs, or on single samples.
    #[test]
    fn another_machine_and_few_samples_are_said() {
        let mut then = slowed(1.0, 1.0);
        then.machine.cpu = "Another CPU".to_owned();
        then.machine.commit = "0000000".to_owned();
        then.results[2].measurement.samples_ns.truncate(5);
        let now = slowed(1.0, 1.0).compared_with(&then);
        let machine =
            "The baseline is of another machine or build: the verdicts compare these too.";
        let cpu = &now.machine.cpu;
        let expected = format!("{machine}\ncpu was \"Another CPU\" and is \"{cpu}\" now");
        assert_eq!(now.doubts, [expected]);
        assert_eq!(now.changes.expect("changes")[1].verdict, "too few samples");
    }

    /// Catches a scene compared with another one of the same file name.
    #[test]
    fn a_scene_is_compared_with_that_of_its_path() {
        let of = |scene: &str, factor| {
            let mut list = slowed(factor, factor).results;
            list.iter_mut().for_each(|record| record.subject.scene = scene.to_owned());
            list
        };
        let list = |groups: Vec<Vec<Record>>| Results { results: groups.concat(), ..results() };
        let then = list(vec![of("a/x.toml", 1.0), of("b/x.toml", 2.0)]);
        let at = |scene: &str| Subject { scene: scene.to_owned(), ..subject() };
        let changes = list(vec![of("b/x.toml", 2.0)]).compared_with(&then).changes;
        assert_eq!(changes.expect("changes")[0].verdict, "as before");
        assert_eq!(comparable(&then, &[at("b/x.toml")]), Ok(()));
        let refused = comparable(&then, &[at("c/x.toml")]).expect_err("which of the two?");
        assert!(refused.starts_with("more than one scene has the file name of c/x.toml: "));
        let one = list(vec![of("a/x.toml", 1.0)]);
        assert_eq!(comparable(&one, &[at("c/x.toml")]), Ok(()));
        assert!(comparable(&one, &[at("c/x.toml"), at("d/x.toml")]).is_err());
        assert!(
            comparable(&list(Vec::new()), &[at("a")]).is_err_and(|e| e.starts_with("it has no"))
        );
    }

    /// A setting that is changed, and how that is told.
    type Setting = (fn(&mut Subject), &'static str);

    /// Catches a setting that makes times incomparable and is not noticed.
    #[test]
    fn a_baseline_of_other_settings_is_refused() {
        let check = |change: fn(&mut Subject)| {
            let mut subject = subject();
            change(&mut subject);
            comparable(&results(), &[subject])
        };
        assert_eq!(check(|_| ()), Ok(()));
        assert_eq!(check(|s| s.scene = "elsewhere/room".to_owned()), Ok(()));
        let changes: [Setting; 12] = [
            (|s| s.scene = "a/hall".to_owned(), "scene was \"room\" and is \"a/hall\" now"),
            (|s| s.width = 501, "width was 500 and is 501 now"),
            (|s| s.height = 1, "height was 400 and is 1 now"),
            (|s| s.antialiasing = 3, "antialiasing was 2 and is 3 now"),
            (
                |s| s.sampling = "importance".to_owned(),
                "sampling was \"lattice\" and is \"importance\" now",
            ),
            (|s| s.adaptive = true, "adaptive was false and is true now"),
            (
                |s| s.formulas = "textbook".to_owned(),
                "formulas was \"robust\" and is \"textbook\" now",
            ),
            (|s| s.precision = "f64".to_owned(), "precision was \"f32\" and is \"f64\" now"),
            (|s| s.lanes = 1, "lanes was 8 and is 1 now"),
            (|s| s.share_samples = false, "share_samples was true and is false now"),
            (|s| s.accel = "none".to_owned(), "accel was \"auto\" and is \"none\" now"),
            (|s| s.tile = 16, "tile was 32 and is 16 now"),
        ];
        let help = "use the same scene and options, or measure a new baseline with these (--json)";
        for (change, difference) in changes {
            assert_eq!(check(change), Err(format!("{difference}: {help}")));
        }
        let both = check(|s| (s.lanes, s.tile) = (4, 7)).expect_err("another");
        assert_eq!(both, format!("lanes was 8 and is 4 now, tile was 32 and is 7 now: {help}"));
    }

    #[test]
    fn what_is_no_list_is_refused() {
        let refused = |text: &str| Results::parse(text).expect_err("no list");
        assert!(refused("{}").starts_with("not the JSON of a comparison: "));
        assert!(refused("[1]").starts_with("not the JSON of a comparison: "));
        assert!(refused(r#"{"schema": 1}"#).starts_with("not the JSON of a comparison: "));
        let later = r#"{"schema": 3, "digest": "", "results": []}"#;
        assert_eq!(
            refused(later),
            "its schema is 3, and this program reads 1 and 2: measure a new baseline"
        );
    }
}
