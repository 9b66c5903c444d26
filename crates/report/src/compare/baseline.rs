//! What has changed since an earlier comparison.

use super::json::{SCHEMA, Settings};
use super::{Report, Subject, scene_file};
use crate::json::Ratio;
use crate::style;
use rayweave_measure::compare::{Role, Row};
use rayweave_measure::statistics::{median_ratio_interval, ratios};
use rayweave_measure::{Comparison, Interval};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// What is read of an earlier comparison's JSON.
#[derive(Clone, Debug, Deserialize)]
pub struct Baseline {
    schema: u32,
    digest: String,
    results: Vec<Earlier>,
    noise: Option<EarlierNoise>,
    /// The settings, among all else.
    #[serde(flatten)]
    rest: Map<String, Value>,
}

#[derive(Clone, Debug, Deserialize)]
struct Earlier {
    strategy: String,
    threads: usize,
    control: bool,
    /// None of rows that failed or gave another picture.
    median_ns: Option<f64>,
    samples_ns: Vec<u64>,
    speedup: Option<Ratio>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
struct EarlierNoise {
    disturbed: bool,
}

/// A row now and then.
pub(super) struct Change<'a> {
    row: &'a Row,
    /// Its time now over its time then.
    time: Option<Interval>,
    /// The same of its time over the reference's in the same run: what changed the whole machine
    /// cancels.
    relative: Option<Interval>,
}

/// The same for other programs.
#[derive(Serialize)]
pub(super) struct Object {
    strategy: &'static str,
    threads: usize,
    time: Option<Ratio>,
    relative_time: Option<Ratio>,
    verdict: &'static str,
}

impl Baseline {
    /// From the JSON of a comparison.
    ///
    /// # Errors
    ///
    /// It is none, or of another schema.
    pub fn parse(text: &str) -> Result<Self, String> {
        let baseline: Self =
            serde_json::from_str(text).map_err(|e| format!("not the JSON of a comparison: {e}"))?;
        if baseline.schema != SCHEMA {
            let (theirs, ours) = (baseline.schema, SCHEMA);
            return Err(format!("its schema is {theirs}, and this program reads {ours}"));
        }
        Ok(baseline)
    }

    /// Finds out whether times of `subject` can be compared with these, before any is taken. The
    /// scene may lie in another folder.
    ///
    /// # Errors
    ///
    /// It was measured with other settings.
    pub fn check(&self, subject: &Subject) -> Result<(), String> {
        let here = serde_json::to_value(Settings::from(subject)).map_err(|e| e.to_string())?;
        let here = here.as_object().into_iter().flatten();
        let differences: Vec<String> = here
            .filter_map(|(key, here)| {
                let there = self.rest.get(key).unwrap_or(&Value::Null);
                (!is_same(there, here)).then(|| format!("{key} is {there} there and {here} here"))
            })
            .collect();
        if differences.is_empty() {
            return Ok(());
        }
        Err(format!(
            "{}: use the same scene and options, or measure a new baseline with these (--json)",
            differences.join(", ")
        ))
    }

    /// Of each row but the control.
    pub(super) fn changes<'a>(&self, comparison: &'a Comparison) -> Vec<Change<'a>> {
        let reference = comparison.rows.first().map(Row::render_ns).unwrap_or_default();
        let earlier_reference =
            self.results.first().map(|result| &result.samples_ns[..]).unwrap_or_default();
        let rows = comparison.rows.iter().filter(|row| row.role != Role::Control);
        rows.map(|row| {
            let now = row.figures.map(|_| row.render_ns()).unwrap_or_default();
            let then = self.samples_of(row);
            let relative = ratios(&now, &reference);
            Change {
                row,
                time: median_ratio_interval(&floats(&now), &floats(then)),
                relative: median_ratio_interval(&relative, &ratios(then, earlier_reference)),
            }
        })
        .collect()
    }

    /// Why its own times are to be doubted, if they are.
    fn doubt(&self) -> Option<String> {
        let control = self.results.iter().find(|earlier| earlier.control);
        let control = control.and_then(|control| control.speedup).map(Interval::from);
        doubt(self.noise.is_some_and(|noise| noise.disturbed), control)
    }

    fn samples_of(&self, row: &Row) -> &[u64] {
        let of_row = |earlier: &&Earlier| {
            let alike = earlier.threads == row.threads && earlier.strategy == row.strategy;
            alike && !earlier.control && earlier.median_ns.is_some()
        };
        self.results.iter().find(of_row).map(|earlier| &earlier.samples_ns[..]).unwrap_or_default()
    }
}

/// Why the times of a run are to be doubted, if they are.
fn doubt(disturbed: bool, control: Option<Interval>) -> Option<String> {
    let off = control.is_some_and(|control| !control.contains(1.0));
    let causes = [
        disturbed.then_some("was disturbed"),
        off.then_some("has a control whose interval does not contain 1"),
    ];
    let causes: Vec<&str> = causes.into_iter().flatten().collect();
    (!causes.is_empty()).then(|| causes.join(" and "))
}

fn is_same(there: &Value, here: &Value) -> bool {
    match (there, here) {
        // Only the scene has a path.
        (Value::String(there), Value::String(here)) => scene_file(there) == scene_file(here),
        _ => there == here,
    }
}

fn floats(samples: &[u64]) -> Vec<f64> {
    samples.iter().map(|&ns| ns as f64).collect()
}

impl Change<'_> {
    /// By the time relative to the reference's; of the reference, whose is always 1, by its time.
    fn verdict(&self) -> &'static str {
        let decisive = if self.row.role == Role::Reference { self.time } else { self.relative };
        match decisive {
            None => "not in both",
            Some(interval) if interval.contains(1.0) => "as before",
            Some(interval) if interval.low > 1.0 => "slower",
            Some(_) => "faster",
        }
    }

    pub(super) fn object(&self) -> Object {
        Object {
            strategy: self.row.strategy,
            threads: self.row.threads,
            time: self.time.map(Ratio::from),
            relative_time: self.relative.map(Ratio::from),
            verdict: self.verdict(),
        }
    }
}

const HEADER: [&str; 5] = [
    "strategy",
    "threads",
    "time now / then\n[95 % interval]",
    "the same, relative\nto the reference",
    "verdict",
];

/// The table below the table.
pub(super) fn text(baseline: &Baseline, report: &Report<'_>) -> String {
    let cell = |interval: Option<Interval>| {
        interval.map_or_else(|| "-".to_owned(), style::precise_interval)
    };
    let changes = baseline.changes(report.comparison);
    let rows = changes.iter().map(|change| {
        let Change { row, time, relative } = change;
        let [time, relative] = [*time, *relative].map(cell);
        [
            row.strategy.to_owned(),
            row.threads.to_string(),
            time,
            relative,
            change.verdict().to_owned(),
        ]
    });
    let mut lines = vec![
        "changes since the baseline".to_owned(),
        String::new(),
        style::table(HEADER, rows, 1..=3),
        String::new(),
        "Two runs differ by drift, too: the verdict is by what is relative to the reference of the same run, but the\n\
         reference's own by its time."
            .to_owned(),
        "Chance alone changes one row in twenty.".to_owned(),
    ];
    if let Some(doubt) = doubt(report.noise.is_disturbing(), report.comparison.control()) {
        lines.push(format!("This run {doubt}: believe no verdict, measure again."));
    }
    if let Some(doubt) = baseline.doubt() {
        lines.push(format!("The baseline {doubt}: believe no verdict, measure a new baseline."));
    }
    if baseline.digest != report.comparison.digest.to_string() {
        lines.push(
            "The baseline drew ANOTHER PICTURE: that may be all of the difference.".to_owned(),
        );
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::super::tests::{comparison, sample, subject, with_report};
    use super::*;
    use rayweave_core::{Formulas, Sampling, Search};

    /// The made-up comparison, its reference and control `reference` and its pool `pool` times as
    /// slow.
    fn slowed(reference: f64, pool: f64) -> Comparison {
        let mut comparison = comparison();
        let noise = [0.99, 1.0, 1.01, 1.0, 0.995, 1.005, 1.0, 1.0];
        for (row, (ns, factor)) in
            comparison.rows.iter_mut().zip([(2e9, reference), (2e9, reference), (1e9, pool)])
        {
            row.samples = noise.map(|noise| sample((ns * factor * noise) as u64)).to_vec();
        }
        comparison
    }

    fn baseline() -> Baseline {
        Baseline::parse(&with_report(&slowed(1.0, 1.0), |report| report.json()))
            .expect("a comparison")
    }

    fn verdicts(now: &Comparison) -> Vec<(&'static str, &'static str)> {
        let baseline = baseline();
        let changes = baseline.changes(now);
        changes.iter().map(|change| (change.row.strategy, change.verdict())).collect()
    }

    /// Catches a machine that is slower taken for a strategy that is, and a ratio that is upside
    /// down.
    #[test]
    fn what_is_slower_and_what_is_the_machine() {
        let rest = [("queue", "not in both"), ("many, \"too\" many", "not in both")];
        let expect = |now: &Comparison, reference, pool| {
            let [queue, many] = rest;
            assert_eq!(verdicts(now), [("sequential", reference), ("pool", pool), queue, many]);
        };
        expect(&slowed(1.0, 1.0), "as before", "as before");
        expect(&slowed(1.0, 1.1), "as before", "slower");
        expect(&slowed(1.0, 0.9), "as before", "faster");
        expect(&slowed(1.1, 1.1), "slower", "as before");
    }

    #[test]
    fn changes_for_people_and_programs() {
        let (now, baseline) = (slowed(1.0, 1.1), baseline());
        let text =
            with_report(&now, |report| Report { baseline: Some(&baseline), ..*report }.table());
        let line = text.lines().find(|line| line.starts_with("pool") && line.ends_with("slower"));
        assert!(line.is_some_and(|line| line.contains("1.100 [1.0")), "{text}");
        assert!(!text.contains("ANOTHER PICTURE"), "{text}");
        let json =
            with_report(&now, |report| Report { baseline: Some(&baseline), ..*report }.json());
        let value: Value = serde_json::from_str(&json).expect("JSON");
        let pool = &value["changes"][1];
        assert_eq!((&pool["strategy"], &pool["verdict"]), (&"pool".into(), &"slower".into()));
        assert!((pool["time"]["median"].as_f64().expect("a number") - 1.1).abs() < 1e-6, "{pool}");
        assert_eq!(
            value["changes"].as_array().map(Vec::len),
            Some(4),
            "the control has no place here"
        );

        let other = Baseline { digest: "of something else".to_owned(), ..baseline };
        let text = with_report(&now, |report| Report { baseline: Some(&other), ..*report }.table());
        assert!(text.contains("ANOTHER PICTURE"), "{text}");
    }

    /// Catches a verdict that rests on a run which was itself no good.
    #[test]
    fn doubtful_runs_are_told() {
        use rayweave_measure::Noise;
        use std::time::Duration;

        // What is said of the run then and of the run now, each a comparison and whether it was
        // disturbed.
        let told = |then: (&Comparison, bool), now: (&Comparison, bool)| {
            let with_noise = |(comparison, disturbed): (&Comparison, bool),
                              show: &dyn Fn(&Report<'_>) -> String| {
                let foreign = Some(Duration::from_secs(if disturbed { 3600 } else { 0 }));
                with_report(comparison, |report| {
                    let noise = Noise { foreign, ..report.noise.clone() };
                    show(&Report { noise: &noise, ..*report })
                })
            };
            let then =
                Baseline::parse(&with_noise(then, &|report| report.json())).expect("a comparison");
            let text =
                with_noise(now, &|report| Report { baseline: Some(&then), ..*report }.table());
            text.lines()
                .filter(|line| line.contains("believe no verdict"))
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        let good = slowed(1.0, 1.0);
        let mut drifted = slowed(1.0, 1.0);
        drifted.rows[1].figures.as_mut().expect("figures").speedup =
            Interval { median: 0.9, low: 0.8, high: 0.99 };
        assert!(told((&good, false), (&good, false)).is_empty(), "good runs are doubted");
        for (run, why) in [
            ((&drifted, false), "has a control whose interval does not contain 1"),
            ((&good, true), "was disturbed"),
            ((&drifted, true), "was disturbed and has a control whose interval does not contain 1"),
        ] {
            let then = format!("The baseline {why}: believe no verdict, measure a new baseline.");
            assert_eq!(told(run, (&good, false)), [then]);
            assert_eq!(
                told((&good, false), run),
                [format!("This run {why}: believe no verdict, measure again.")]
            );
        }
    }

    /// A setting that is changed, and how that is told.
    type Setting = (fn(&mut Subject), &'static str);

    /// Catches a setting that makes times incomparable and is not noticed.
    #[test]
    fn a_baseline_of_other_settings_is_refused() {
        let check = |change: fn(&mut Subject)| {
            let mut subject = subject();
            change(&mut subject);
            baseline().check(&subject)
        };
        assert_eq!(check(|_| ()), Ok(()));
        assert_eq!(check(|s| s.scene = "elsewhere/room".to_owned()), Ok(()));
        let changes: [Setting; 12] = [
            (|s| s.scene = "a/hall".to_owned(), "scene is \"room\" there and \"a/hall\" here"),
            (|s| s.width = 501, "width is 500 there and 501 here"),
            (|s| s.height = 1, "height is 400 there and 1 here"),
            (|s| s.antialiasing = 3, "antialiasing is 2 there and 3 here"),
            (
                |s| s.sampling = Sampling::Importance,
                "sampling is \"lattice\" there and \"importance\" here",
            ),
            (|s| s.adaptive = true, "adaptive is false there and true here"),
            (
                |s| s.formulas = Formulas::Textbook,
                "formulas is \"robust\" there and \"textbook\" here",
            ),
            (|s| s.precision = "f64".to_owned(), "precision is \"f32\" there and \"f64\" here"),
            (|s| s.lanes = 1, "lanes is 8 there and 1 here"),
            (|s| s.share_samples = false, "share_samples is true there and false here"),
            (|s| s.search = Search::Exhaustive, "search is \"auto\" there and \"exhaustive\" here"),
            (|s| s.tile = 16, "tile is 32 there and 16 here"),
        ];
        let help = "use the same scene and options, or measure a new baseline with these (--json)";
        for (change, difference) in changes {
            assert_eq!(check(change), Err(format!("{difference}: {help}")));
        }
        let both = check(|s| (s.lanes, s.tile) = (4, 7)).expect_err("another");
        assert_eq!(
            both,
            format!("lanes is 8 there and 4 here, tile is 32 there and 7 here: {help}")
        );
    }

    #[test]
    fn what_is_no_baseline_is_refused() {
        let refused = |text: &str| Baseline::parse(text).expect_err("no baseline");
        assert!(refused("{}").starts_with("not the JSON of a comparison: "));
        assert!(refused("[1]").starts_with("not the JSON of a comparison: "));
        let later = r#"{"schema": 2, "digest": "", "results": []}"#;
        assert_eq!(refused(later), "its schema is 2, and this program reads 1");
        assert!(Baseline::parse(&later.replace('2', "1")).is_ok());
    }
}
