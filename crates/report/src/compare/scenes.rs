//! Several scenes beside each other: which strategy wins where, and why.

use super::table::label;
use super::{Report, csv, json, markdown, scene_file};
use crate::{machine, style};
use rayweave_contract::{Granularity, Scheduling};
use rayweave_measure::compare::{Role, Row};
use rayweave_measure::{Interval, Load};

/// The comparisons of the same rows on several scenes.
#[derive(Clone, Copy, Debug)]
pub struct ScenesReport<'a> {
    /// One for each scene, one or more.
    pub reports: &'a [Report<'a>],
    /// How the cost lies in the scenes' pictures.
    pub loads: &'a [&'a Load],
    /// The scenes that an interruption left out.
    pub not_measured: &'a [String],
}

/// Below it the cost counts as even.
const EVEN: f64 = 1.1;

/// Below it a picture counts as nearly free: starting a few threads takes a percent of it.
const FREE_NS: f64 = 1e7;

impl ScenesReport<'_> {
    /// For people: a row a strategy, a column a scene, and a sentence on each scene. Plain text
    /// without a newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        let header = ["strategy".to_owned(), "threads".to_owned()];
        let header: Vec<String> = header.into_iter().chain(self.reports.iter().map(name)).collect();
        let rows = self.rows(|best| format!("* {best}"));
        let table = style::table(header, rows.into_iter(), 1..=1 + self.reports.len());
        let mut lines = vec![
            "speed-up over the reference of the same scene [95 % interval]; * the highest of a scene"
                .to_owned(),
            String::new(),
            table,
            String::new(),
        ];
        lines.extend(self.notes());
        lines.extend(self.reports.first().map(|report| machine::text(report.machine)));
        lines.join("\n")
    }

    /// A sentence on each scene, and what is to be doubted.
    fn notes(&self) -> Vec<String> {
        let mut lines: Vec<String> =
            self.reports.iter().zip(self.loads).map(|(report, load)| why(report, load)).collect();
        let disturbed = self.reports.iter().filter(|report| report.noise.is_disturbing()).map(name);
        let disturbed: Vec<String> = disturbed.collect();
        if !disturbed.is_empty() {
            lines.push(format!("DISTURBED by other programs: {}.", disturbed.join(", ")));
        }
        let interrupted = self.reports.iter().filter(|report| report.comparison.interrupted);
        lines.extend(interrupted.map(|report| {
            format!("INTERRUPTED: {} after {} rounds.", name(report), report.comparison.rounds)
        }));
        if !self.not_measured.is_empty() {
            lines.push(format!(
                "INTERRUPTED before it was measured: {}.",
                self.not_measured.join(", ")
            ));
        }
        lines
    }

    /// For programs: `schema`, 1, `comparisons`, a list of [`Report::json`]'s objects, and
    /// `not_measured`.
    #[must_use]
    pub fn json(&self) -> String {
        json::several(self.reports, self.not_measured)
    }

    /// The lines of [`Report::csv`] of all scenes.
    #[must_use]
    pub fn csv(&self) -> String {
        csv::several(self.reports)
    }

    /// What [`ScenesReport::table`] says, then the tables of [`Report::markdown`], one after the
    /// other.
    #[must_use]
    pub fn markdown(&self) -> String {
        let names: Vec<String> = self.reports.iter().map(name).collect();
        let rows = self.rows(|best| format!("**{best}**"));
        let tables: String =
            self.reports.iter().map(|report| format!("\n{}", report.markdown())).collect();
        markdown::summary(&names, &rows, &self.notes()) + &tables
    }

    /// A row's name, its threads and its speed-up in each scene, the highest of a scene `marked`.
    fn rows(&self, marked: impl Fn(String) -> String) -> Vec<Vec<String>> {
        let rows =
            self.reports.first().map(|report| &report.comparison.rows[..]).unwrap_or_default();
        let cell = |report: &Report<'_>, number: usize| {
            let row = &report.comparison.rows[number];
            let Some(speedup) = speedup(row).map(style::interval) else {
                return "failed".to_owned();
            };
            let best = winner(report).is_some_and(|best| std::ptr::eq(best, row));
            if best { marked(speedup) } else { speedup }
        };
        let cells = |(number, row)| {
            let head = [label(row), row.threads.to_string()];
            head.into_iter().chain(self.reports.iter().map(|report| cell(report, number))).collect()
        };
        rows.iter().enumerate().map(cells).collect()
    }
}

fn speedup(row: &Row) -> Option<Interval> {
    row.figures.map(|figures| figures.speedup)
}

/// The scene's file without its folder and ending.
fn name(report: &Report<'_>) -> String {
    let file = scene_file(&report.subject.scene);
    file.strip_suffix(".toml").unwrap_or(file).to_owned()
}

/// The row of the highest speed-up, but for the control, which is no other than the reference.
fn winner<'a>(report: &Report<'a>) -> Option<&'a Row> {
    best(report, |row| row.role != Role::Control)
}

fn best<'a>(report: &Report<'a>, which: impl Fn(&Row) -> bool) -> Option<&'a Row> {
    let median = |row: &Row| speedup(row).map_or(0.0, |speedup| speedup.median);
    let rows = report.comparison.rows.iter().filter(|row| row.figures.is_some() && which(row));
    rows.max_by(|a, b| median(a).total_cmp(&median(b)))
}

/// A sentence or two: who wins, and what of the cost makes the difference.
fn why(report: &Report<'_>, load: &Load) -> String {
    let Some((winner, won)) = winner(report).and_then(|row| Some((row, speedup(row)?))) else {
        return format!("{}: nothing was measured.", name(report));
    };
    let threads = report.comparison.rows.iter().map(|row| row.threads).max().unwrap_or(1);
    let others = || report.comparison.rows.iter().filter(|row| row.role != Role::Control);
    let as_good =
        others().filter(|row| speedup(row).is_some_and(|other| other.high >= won.low)).count() - 1;
    let certain = others().filter(|row| speedup(row).is_some_and(|other| other.low > 1.0));
    let certain: Vec<&str> = certain.map(|row| row.strategy).collect();
    let strategy = winner.strategy;
    let verdict = if winner.role == Role::Reference {
        format!("no strategy pays, {strategy} is first")
    } else if certain.is_empty() {
        format!("no strategy is faster than alone for certain, {strategy} comes first")
    } else if won.low <= 1.0 {
        format!("{strategy} comes first; faster than alone for certain: {}", certain.join(", "))
    } else {
        let scheduling = scheduling(winner.policy.scheduling);
        format!("{strategy} ({scheduling}) is first, with {as_good} more within the intervals")
    };
    let mut parts = vec![format!("{}: {verdict}", name(report))];
    let uneven = load.unevenness(threads);
    parts.push(if uneven < EVEN {
        format!("the cost is even, equal shares of tiles differ by {:.0} %", (uneven - 1.0) * 100.0)
    } else {
        let equal_tiles = |row: &Row| row.policy.scheduling == Scheduling::Static && row.policy.granularity == Granularity::Tile;
        let equal = best(report, |row| equal_tiles(row) && row.threads == threads).and_then(speedup);
        let measured = equal.map(|equal| format!(", {:.2} was measured", equal.median)).unwrap_or_default();
        let most = threads as f64 / uneven;
        format!("equal shares of tiles: max over mean cost is {uneven:.2}, so at most {most:.2}{measured}")
    });
    let dearest = load.dearest_tile();
    if dearest * threads as f64 > 1.0 {
        let (share, most) = (dearest * 100.0, 1.0 / dearest);
        parts.push(format!(
            "one tile has {share:.0} % of the cost, so whole tiles allow at most {most:.2}"
        ));
    }
    let whole =
        report.comparison.rows.first().and_then(|row| row.figures).map(|figures| figures.median_ns);
    if let Some(ns) = whole.filter(|&ns| ns < FREE_NS) {
        parts.push(format!(
            "all pixels take {:.2} ms, so starting threads and dealing out count",
            ns / 1e6
        ));
    }
    parts.join("; ") + "."
}

fn scheduling(scheduling: Scheduling) -> &'static str {
    match scheduling {
        Scheduling::Static => "equal shares",
        Scheduling::Dynamic { .. } => "the next piece to whoever is free",
        Scheduling::Guided => "ever fewer pieces to whoever is free",
        Scheduling::WorkStealing => "shares, and half of another's to who is idle",
        Scheduling::RecursiveSplit => "halves of the range to who is idle",
    }
}

#[cfg(test)]
mod tests {
    use super::super::Subject;
    use super::super::tests::{comparison, machine, noise, subject};
    use super::*;
    use rayweave_measure::compare::Figures;
    use std::time::Duration;

    fn load(costs: &[u64]) -> Load {
        Load::new(costs.iter().map(|&ms| Duration::from_millis(ms)).collect())
    }

    fn with_scenes(read: impl FnOnce(&ScenesReport<'_>) -> String) -> String {
        let (mut even, mut corner) = (comparison(), comparison());
        for comparison in [&mut even, &mut corner] {
            // Of the largest number of threads, which the bound is for.
            comparison.rows[2].threads =
                comparison.rows.iter().map(|row| row.threads).max().expect("rows");
            let policy = &mut comparison.rows[2].policy;
            (policy.scheduling, policy.granularity) = (Scheduling::Static, Granularity::Tile);
        }
        // In the corner the pool loses to the reference.
        let figures = corner.rows[2].figures.as_mut().expect("figures");
        figures.speedup = Interval { median: 0.9, low: 0.85, high: 0.95 };
        corner.rows[0].figures.as_mut().expect("figures").median_ns = 5e6;
        let named = |scene: &str| Subject { scene: scene.to_owned(), ..subject() };
        let subjects = [named("a/even.toml"), named("corner.toml")];
        let (machine, noise) = (machine(), noise());
        let report = |(subject, comparison)| Report {
            subject,
            comparison,
            machine: &machine,
            noise: &noise,
            baseline: None,
        };
        let reports: Vec<Report<'_>> = subjects.iter().zip([&even, &corner]).map(report).collect();
        let costs = vec![1; 9000];
        let uneven: Vec<u64> = std::iter::once(27_000).chain(costs.iter().copied()).collect();
        let (even, uneven) = (load(&costs), load(&uneven));
        let not_measured = ["later.toml".to_owned()];
        read(&ScenesReport {
            reports: &reports,
            loads: &[&even, &uneven],
            not_measured: &not_measured,
        })
    }

    #[test]
    fn the_winner_is_marked_and_the_reason_told() {
        let text = with_scenes(|scenes| scenes.table());
        let line = |start: &str| {
            text.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{text}"))
        };
        assert!(line("strategy").contains("even") && line("strategy").ends_with("corner"));
        assert!(
            line("pool").contains("* 1.95 [1.91, 2.01]")
                && line("pool").ends_with("  0.90 [0.85, 0.95]")
        );
        assert!(
            line("sequential  ").ends_with("* 1.00 [0.96, 1.06]")
                && line("queue").contains("failed")
        );
        assert_eq!(
            line("even:"),
            "even: pool (equal shares) is first, with 0 more within the intervals; the cost is even, equal shares \
             of tiles differ by 0 %."
        );
        assert_eq!(line("INTERRUPTED"), "INTERRUPTED before it was measured: later.toml.");
        // 9000 threads and a tile more than that: the first range is the dear tile alone, 3/4 of
        // all.
        assert_eq!(
            line("corner:"),
            "corner: no strategy pays, sequential is first; \
             equal shares of tiles: max over mean cost is 6750.00, so at most 1.33, 0.90 was measured; one tile has \
             75 % of the cost, so whole tiles allow at most 1.33; all pixels take 5.00 ms, so starting threads and \
             dealing out count."
        );
    }

    /// Catches a winner that may be slower than a single thread.
    #[test]
    fn a_lead_within_the_interval_is_none() {
        let mut comparison = comparison();
        comparison.rows[2].figures.as_mut().expect("figures").speedup =
            Interval { median: 1.2, low: 0.9, high: 1.6 };
        let (subject, machine, noise) = (subject(), machine(), noise());
        let report = Report {
            subject: &subject,
            comparison: &comparison,
            machine: &machine,
            noise: &noise,
            baseline: None,
        };
        let told = why(&report, &load(&[1, 1]));
        assert!(
            told.contains(": no strategy is faster than alone for certain, pool comes first;"),
            "{told}"
        );

        // Another is, though its median is lower.
        let mut comparison = comparison.clone();
        let queue = comparison.rows[2].figures.map(|figures| Figures {
            speedup: Interval { median: 1.1, low: 1.05, high: 1.2 },
            ..figures
        });
        comparison.rows[3].figures = queue;
        let told = why(&Report { comparison: &comparison, ..report }, &load(&[1, 1]));
        assert!(
            told.contains(": pool comes first; faster than alone for certain: queue;"),
            "{told}"
        );
    }

    #[test]
    fn for_programs_it_is_one_comparison_after_the_other() {
        let json = with_scenes(|scenes| scenes.json());
        let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(value["schema"], 1);
        assert_eq!(value["comparisons"][1]["scene"], "corner.toml");
        assert_eq!(value["not_measured"], serde_json::json!(["later.toml"]));
        let csv = with_scenes(|scenes| scenes.csv());
        assert_eq!(csv.lines().count(), 1 + 2 * 5);
    }

    #[test]
    fn markdown_begins_with_who_wins_where() {
        let markdown = with_scenes(|scenes| scenes.markdown());
        let (text, lines) =
            (with_scenes(|scenes| scenes.table()), markdown.lines().collect::<Vec<_>>());
        let head = "speed-up over the reference of the same scene [95 % interval]; the highest of a scene in bold";
        assert_eq!(lines[..2], [head, ""]);
        assert_eq!(lines[2..4], ["| strategy | threads | even | corner |", "|---|--:|--:|--:|"]);
        assert_eq!(lines[4], "| sequential | 1 | 1.00 [0.96, 1.06] | **1.00 [0.96, 1.06]** |");
        assert_eq!(lines[6], "| pool | 9000 | **1.95 [1.91, 2.01]** | 0.90 [0.85, 0.95] |");
        let sentences: Vec<&str> =
            lines.iter().filter_map(|line| line.strip_prefix("- ")).collect();
        assert!(
            sentences.len() == 3 && sentences.iter().all(|sentence| text.contains(sentence)),
            "{markdown}"
        );
        assert_eq!(markdown.matches("| pool | 9000 | 1026 |").count(), 2, "{markdown}");
        assert!(
            markdown
                .contains("| sequential (control) | 1 | 2010 | 1.00 [0.96, 1.06] | 100 % | 2512 |")
        );
        assert!(markdown.contains("| queue | 2 | wrong picture | | | |"), "{markdown}");
        assert!(markdown.contains("| many, \"too\" many | 9000 | failed | | | |"), "{markdown}");
    }
}
