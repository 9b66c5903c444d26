//! The list as one table with a column for each scene, and a sentence for each scene on which
//! strategy wins and why.

use super::lessons::EVEN;
use super::{Record, Results, changes, markdown, scene_name, screen};
use crate::machine;
use crate::style::{self, clipped, wrapped};
use rayweave_contract::{Granularity, Scheduling};
use rayweave_measure::Interval;

/// The time of an image below which starting a few threads takes a percent of it or more.
const FREE_NS: u64 = 10_000_000;

pub(super) fn text(results: &Results) -> String {
    let groups: Vec<&[Record]> = results.groups().collect();
    let header = ["strategy".to_owned(), "threads".to_owned()];
    let header: Vec<String> = header.into_iter().chain(names(&groups)).collect();
    let rows = rows(&groups, style::interval, |best| format!("* {best}"));
    let mut lines = vec![
        "speed-up over the reference of the same scene [95 % interval]; *: highest of the scene"
            .to_owned(),
        String::new(),
        style::table(header, rows.into_iter(), 1..=1 + groups.len()),
        String::new(),
    ];
    lines.extend(notes(results, &groups));
    lines.push(machine::text(&results.machine));
    lines.extend(changes::text(results, style::precise_interval));
    lines.join("\n")
}

/// The most scenes that stand side by side in lines of 80 columns.
const MOST_SCENES: usize = 5;

/// The longest names of a strategy and of a scene that are shown whole.
const NAMES: (usize, usize) = (20, 8);

/// Returns the lines of the same table without intervals, and the sentences. No line is longer than
/// 80 columns.
pub(super) fn first_screen(results: &Results) -> Vec<String> {
    let groups: Vec<&[Record]> = results.groups().collect();
    let mut lines: Vec<String> = groups.iter().map(|group| wrapped(&why(group), "  ")).collect();
    lines.extend([String::new(), "speed-up over one thread; *: highest of the scene".to_owned()]);
    for groups in groups.chunks(MOST_SCENES) {
        let names = names(groups).into_iter().map(|name| clipped(&name, NAMES.1));
        let header: Vec<String> = ["strategy".to_owned()].into_iter().chain(names).collect();
        let rows =
            rows(groups, |speedup| format!("{:.2}", speedup.median), |best| format!("*{best}"));
        let rows = rows.into_iter().map(|row| {
            let [strategy, threads, cells @ ..] = &row[..] else { return row };
            let name = format!("{} x{threads}", clipped(strategy, NAMES.0));
            [&[name], cells].concat()
        });
        lines.push(style::table(header, rows, 1..=groups.len()));
        lines.push(String::new());
    }
    lines.extend(groups.first().map(|group| screen::work(&group[0].subject)));
    lines.extend(doubts(results, &groups).iter().map(|line| wrapped(line, "")));
    lines
}

/// Returns the same table and sentences in Markdown.
pub(super) fn markdown(results: &Results) -> String {
    let groups: Vec<&[Record]> = results.groups().collect();
    let rows = rows(&groups, style::interval, |best| format!("**{best}**"));
    markdown::summary(&names(&groups), &rows, &notes(results, &groups)) + "\n"
}

fn names(groups: &[&[Record]]) -> Vec<String> {
    groups.iter().map(|group| scene_name(&group[0]).to_owned()).collect()
}

/// Returns a sentence for each scene, and the reasons to doubt its figures.
fn notes(results: &Results, groups: &[&[Record]]) -> Vec<String> {
    groups.iter().map(|group| why(group)).chain(doubts(results, groups)).collect()
}

fn doubts(results: &Results, groups: &[&[Record]]) -> Vec<String> {
    let mut lines = Vec::new();
    let disturbed = groups.iter().filter(|group| group[0].disturbed);
    let disturbed: Vec<&str> = disturbed.map(|group| scene_name(&group[0])).collect();
    if !disturbed.is_empty() {
        lines.push(format!("DISTURBED by other programs: {}.", disturbed.join(", ")));
    }
    let interrupted = groups.iter().map(|group| &group[0]).filter(|first| first.interrupted);
    lines.extend(
        interrupted.map(|first| {
            format!("INTERRUPTED: {} after {} rounds.", scene_name(first), first.rounds)
        }),
    );
    if !results.not_measured.is_empty() {
        lines.push(format!(
            "INTERRUPTED before it was measured: {}.",
            results.not_measured.join(", ")
        ));
    }
    lines
}

/// Returns name, threads and speed-up in each scene of each row. `shown` is a speed-up as text, and
/// `marked` marks the highest of a scene.
fn rows(
    groups: &[&[Record]],
    shown: impl Fn(Interval) -> String,
    marked: impl Fn(String) -> String,
) -> Vec<Vec<String>> {
    let cell = |group: &&[Record], wanted: &Record| {
        let alike = |record: &&Record| {
            record.label() == wanted.label()
                && record.measurement.threads == wanted.measurement.threads
        };
        let record = group.iter().find(alike);
        let Some(speedup) = record.and_then(|record| record.measurement.speedup) else {
            return "failed".to_owned();
        };
        let best = winner(group).is_some_and(|best| alike(&best));
        if best { marked(shown(speedup)) } else { shown(speedup) }
    };
    let first = groups.first().copied().unwrap_or_default();
    let row = |record: &Record| {
        let head = [record.label(), record.measurement.threads.to_string()];
        head.into_iter().chain(groups.iter().map(|group| cell(group, record))).collect()
    };
    first.iter().map(row).collect()
}

/// Returns the record of the highest speed-up that is not the control.
fn winner(group: &[Record]) -> Option<&Record> {
    best(group, |record| !record.measurement.control)
}

fn best(group: &[Record], which: impl Fn(&Record) -> bool) -> Option<&Record> {
    let median = |record: &Record| record.measurement.speedup.map(|speedup| speedup.median);
    let records = group.iter().filter(|record| median(record).is_some() && which(record));
    records.max_by(|a, b| median(a).unwrap_or_default().total_cmp(&median(b).unwrap_or_default()))
}

/// Returns the winner of a scene, and the property of the cost that makes the difference.
fn why(group: &[Record]) -> String {
    let name = scene_name(&group[0]);
    let speedup = |record: &Record| record.measurement.speedup;
    let Some((winner, won)) = winner(group).and_then(|record| Some((record, speedup(record)?)))
    else {
        return format!("{name}: nothing was measured.");
    };
    let others = || group.iter().filter(|record| !record.measurement.control);
    let as_good =
        others().filter(|row| speedup(row).is_some_and(|other| other.high >= won.low)).count() - 1;
    let certain = others().filter(|row| speedup(row).is_some_and(|other| other.low > 1.0));
    let certain: Vec<&str> = certain.map(|row| &*row.measurement.strategy).collect();
    let strategy = &winner.measurement.strategy;
    let verdict = if std::ptr::eq(winner, &raw const group[0]) {
        format!("no strategy pays off, {strategy} is fastest")
    } else if certain.is_empty() {
        format!("no strategy is certainly faster than one thread; {strategy} has the best median")
    } else if won.low <= 1.0 {
        let certain = certain.join(", ");
        format!("{strategy} has the best median; certainly faster than one thread: {certain}")
    } else {
        let scheduling = scheduling(&winner.measurement.scheduling);
        format!("{strategy} ({scheduling}) is fastest; {as_good} others overlap its interval")
    };
    let mut parts = vec![format!("{name}: {verdict}")];
    parts.extend(cost(group));
    if let Some(ns) = group[0].measurement.median_ns.filter(|&ns| ns < FREE_NS) {
        parts.push(format!(
            "the whole image takes {:.2} ms, so starting threads and scheduling matter",
            ns as f64 / 1e6
        ));
    }
    parts.join("; ") + "."
}

/// Returns the limits that the cost of the tiles sets to the largest number of threads.
fn cost(group: &[Record]) -> Vec<String> {
    let Some(record) = group.iter().max_by_key(|record| record.measurement.threads) else {
        return Vec::new();
    };
    let (threads, mut parts) = (record.measurement.threads, Vec::new());
    if let Some(imbalance) = record.imbalance {
        let (scheduling, tile) = (Scheduling::Static.to_string(), Granularity::Tile.to_string());
        let equal = best(group, |record| {
            let row = &record.measurement;
            (&row.scheduling, &row.granularity, row.threads) == (&scheduling, &tile, threads)
        });
        let equal = equal.and_then(|record| record.measurement.speedup);
        let measured =
            equal.map(|equal| format!(" (measured: {:.2})", equal.median)).unwrap_or_default();
        let most = threads as f64 / imbalance;
        parts.push(if imbalance < EVEN {
            let percent = (imbalance - 1.0) * 100.0;
            format!("the cost is even: equal shares of tiles differ by {percent:.0} %")
        } else {
            format!(
                "with equal shares of tiles the busiest thread has {imbalance:.2} times the mean \
                 cost, so at most {most:.2}{measured}"
            )
        });
    }
    if let Some(share) = record.largest_tile.filter(|share| share * threads as f64 > 1.0) {
        parts.push(format!(
            "one tile has {:.0} % of the cost, so whole tiles allow at most {:.2}",
            share * 100.0,
            1.0 / share
        ));
    }
    parts
}

/// Returns in words how pieces are scheduled.
fn scheduling(word: &str) -> &'static str {
    match word {
        "static" => "equal shares",
        "guided" => "shrinking chunks to free threads",
        "work-stealing" => "equal shares; idle threads steal half of another's",
        "recursive-split" => "halves of the range to idle threads",
        _ => "the next piece to a free thread",
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{machine, noise, records};
    use super::*;

    /// Returns the made-up list on two scenes: an even one, and one with three quarters of the cost
    /// in one tile, where the pool loses to the reference.
    fn two_scenes() -> Results {
        let (mut even, mut corner) = (records(), records());
        for (group, scene, costs) in [
            (&mut even, "a/even.toml", (1.0, 1.0 / 9001.0)),
            (&mut corner, "corner.toml", (6750.0, 0.75)),
        ] {
            for record in &mut *group {
                record.subject.scene = scene.to_owned();
                (record.imbalance, record.largest_tile) = (Some(costs.0), Some(costs.1));
            }
            // The limits are for the largest number of threads.
            group[2].measurement.threads = 9000;
            group[2].measurement.scheduling = "static".to_owned();
        }
        corner[2].measurement.speedup = Some(Interval { median: 0.9, low: 0.85, high: 0.95 });
        corner[0].measurement.median_ns = Some(5_000_000);
        let mut results = Results::new(machine(), noise(), [even, corner].concat());
        results.not_measured = vec!["later.toml".to_owned()];
        results
    }

    #[test]
    fn the_winner_is_marked_and_the_reason_told() {
        let text = two_scenes().table(&[]);
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
            "even: pool (equal shares) is fastest; 0 others overlap its interval; the cost is \
             even: equal shares of tiles differ by 0 %."
        );
        assert_eq!(line("INTERRUPTED"), "INTERRUPTED before it was measured: later.toml.");
        // With one tile more than 9000 threads the first range is the costly tile alone: 3/4 of
        // the cost.
        assert_eq!(
            line("corner:"),
            "corner: no strategy pays off, sequential is fastest; with equal shares of \
             tiles the busiest thread has 6750.00 times the mean cost, so at most 1.33 (measured: \
             0.90); one tile has 75 % of the cost, so whole tiles allow at most 1.33; the whole \
             image takes 5.00 ms, so starting threads and scheduling matter."
        );
    }

    /// Catches a winner that may be slower than a single thread.
    #[test]
    fn a_lead_within_the_interval_is_none() {
        let mut group = records();
        group[2].measurement.speedup = Some(Interval { median: 1.2, low: 0.9, high: 1.6 });
        let told = why(&group);
        let expected =
            ": no strategy is certainly faster than one thread; pool has the best median.";
        assert!(told.ends_with(expected), "{told}");

        // Another is, though its median is lower.
        group[3].measurement.speedup = Some(Interval { median: 1.1, low: 1.05, high: 1.2 });
        let told = why(&group);
        let expected = ": pool has the best median; certainly faster than one thread: queue.";
        assert!(told.ends_with(expected), "{told}");
    }

    #[test]
    fn markdown_begins_with_who_wins_where() {
        let markdown = two_scenes().markdown();
        let (text, lines) = (two_scenes().table(&[]), markdown.lines().collect::<Vec<_>>());
        let head = "speed-up over the reference of the same scene [95 % interval]; the highest of \
                    a scene in bold";
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
        assert!(markdown.contains("| queue | 2 | wrong image | | | |"), "{markdown}");
        assert!(markdown.contains("| many, \"too\" many | 9000 | failed | | | |"), "{markdown}");
    }
}
