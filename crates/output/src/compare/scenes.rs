//! The list as one table with a column for each scene, and a sentence for each scene on which
//! strategy wins and why.

use super::lessons::EVEN_IMBALANCE;
use super::ranking::Section;
use super::{Record, Results, changes, markdown, scene_name, screen, verdict};
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
    lines.extend(groups.first().map(|group| screen::work_sentence(&group[0].subject)));
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

/// Returns the sentences on which strategies are fastest on a scene, and one on the properties of
/// the cost that make the difference.
fn why(group: &[Record]) -> String {
    let mut sentences = verdict::sentences(group, &Section::all(group));
    let mut parts = cost(group);
    if let Some(ns) = group[0].measurement.median_ns.filter(|&ns| ns < FREE_NS) {
        parts.push(format!(
            "the whole image takes {:.2} ms, so starting threads and scheduling matter",
            ns as f64 / 1e6
        ));
    }
    let cost = parts.join("; ");
    let mut letters = cost.chars();
    sentences.extend(
        letters.next().map(|first| format!("{}{}.", first.to_uppercase(), letters.as_str())),
    );
    format!("{}: {}", scene_name(&group[0]), sentences.join(" "))
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
        parts.push(if imbalance < EVEN_IMBALANCE {
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
            "even: Fastest on 9000 threads: pool, 1.9 times as fast as one thread. On 2 threads no \
             strategy gave figures to compare. The cost is even: equal shares of tiles differ by \
             0 %."
        );
        assert_eq!(line("INTERRUPTED"), "INTERRUPTED before it was measured: later.toml.");
        // With one tile more than 9000 threads the first range is the costly tile alone: 3/4 of
        // the cost.
        assert_eq!(
            line("corner:"),
            "corner: On 9000 threads no strategy is seen to be faster than the plain loop on one \
             thread; the highest median is pool, 0.90 (0.85-0.95). On 2 threads no strategy gave \
             figures to compare. With equal shares of tiles the busiest thread has 6750.00 times \
             the mean cost, so at most 1.33 (measured: 0.90); one tile has 75 % of the cost, so \
             whole tiles allow at most 1.33; the whole image takes 5.00 ms, so starting threads \
             and scheduling matter."
        );
    }

    /// Catches another rule than that of a single scene: overlapping intervals do not mean that two
    /// rows cannot be told apart, because a slow round slows both.
    #[test]
    fn scenes_are_ranked_like_a_single_one() {
        let mut results = two_scenes();
        let mut slower = results.results[2].clone();
        slower.measurement.strategy = "slower".to_owned();
        slower.measurement.samples_ns = vec![1_200_000_000; 2];
        results.results.insert(3, slower);
        for text in [results.table(&[]), results.screen(&[]).replace("\n  ", " ")] {
            let expected = "even: Fastest on 9000 threads: pool, 1.9 times as fast as one thread; \
                            slower takes 17 % longer.";
            assert!(text.contains(expected), "{text}");
        }
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
