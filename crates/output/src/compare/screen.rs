//! The list as the first screen: a sentence, what was measured, a bar a row, what the figures
//! teach, and which differences to trust. No line is longer than 80 columns.

use super::lessons;
use super::ranking::{Section, is_static, rank};
use super::table::{computed, goal_line, milliseconds, rays_each, reference};
use super::verdict::{sentences, threads, trust};
use super::{BUILT_IN_SCENE, Record, Results, Subject, changes, complaint, control, scene_file};
use super::{scenes, short};
use crate::style::{self, WIDTH, clipped, wrapped};
use crate::{machine, noise};
use rayweave_contract::{Granularity, Output};
use rayweave_measure::Interval;
use std::collections::BTreeSet;

/// The length of a bar at the end of the scale.
const BAR: usize = 20;

/// The longest name of a row that is shown whole.
const NAME: usize = 24;

pub(super) fn text(results: &Results, notes: &[String]) -> String {
    let mut lines =
        if results.has_scenes() { scenes::first_screen(results) } else { subjects(results) };
    if results.noise.disturbed {
        lines.extend(noise::text(&results.noise).lines().map(|line| wrapped(line, "")));
    }
    lines.extend(notes.iter().map(|note| wrapped(note, "")));
    lines.push(wrapped(&machine::short(&results.machine), ""));
    lines.push(
        "All columns: --full. Why one loses: rayweave explain --strategy NAME.\n\
         What each does: rayweave strategies. More threads: rayweave predict."
            .to_owned(),
    );
    let changes = changes::text(results, style::interval).unwrap_or_default();
    // Lines of a table fit.
    lines.extend(changes.lines().map(|line| {
        if line.chars().count() > WIDTH { wrapped(line, "") } else { line.to_owned() }
    }));
    lines.join("\n")
}

/// Returns the lines of each subject, one below the other.
fn subjects(results: &Results) -> Vec<String> {
    let several = results.groups().count() > 1;
    let available = results.machine.available_threads.max(1);
    let mut lines = Vec::new();
    for group in results.groups() {
        let sections = Section::all(group);
        if several {
            let samples = if group[0].subject.share_samples { "shared" } else { "not shared" };
            lines.push(format!("Samples {samples}."));
        }
        lines.extend(sentences(group, &sections).iter().map(|line| wrapped(line, "")));
        lines.extend([String::new(), wrapped(&measured(group), ""), String::new()]);
        for section in &sections {
            lines.extend((sections.len() > 1).then(|| format!("On {}:", threads(section.threads))));
            lines.extend(chart(section, available));
            lines.push(String::new());
        }
        let complaints = group.iter().filter_map(|record| complaint(&record.measurement));
        let complaints: Vec<String> = complaints.map(|line| wrapped(&line, "")).collect();
        if !complaints.is_empty() {
            lines.extend(complaints.into_iter().chain([String::new()]));
        }
        let lessons = lessons::of(group, &sections, available);
        lines.extend(
            lessons
                .iter()
                .zip(1..)
                .map(|(lesson, number)| wrapped(&format!("{number} {lesson}"), "  ")),
        );
        lines.extend(control(group).map(|interval| wrapped(&trust(interval), "")));
        lines.extend(results.precision_goal.map(|goal| wrapped(&goal_line(group, goal), "")));
        if several {
            lines.push(String::new());
        }
    }
    lines.extend(results.sharing_speedup.map(|gain| {
        let Interval { median, low, high } = gain;
        wrapped(
            &format!(
                "Sharing samples makes {} {median:.2} times as fast ({low:.2}-{high:.2}), in the \
                 same rounds.",
                reference(&results.results)
            ),
            "",
        )
    }));
    lines
}

/// Returns what was measured: image, number of strategies, time of the reference, and rounds.
fn measured(group: &[Record]) -> String {
    let Record { subject, rounds, interrupted, reference_digest, .. } = &group[0];
    let scene = match &*subject.scene {
        BUILT_IN_SCENE => "The lab report's scene",
        path => scene_file(path),
    };
    let strategies: BTreeSet<&str> =
        group.iter().map(|record| &*record.measurement.strategy).collect();
    let plural = if strategies.len() == 1 { "strategy" } else { "strategies" };
    let bits = if group.iter().all(|record| record.measurement.passed()) {
        "all with the same bits"
    } else {
        "NOT all with the same bits, see below"
    };
    let alone = group[0]
        .measurement
        .median_ns
        .map(|ns| format!(" One thread takes {} ms;", milliseconds(ns)));
    let rounds = format!("{}{rounds} rounds", if *interrupted { "interrupted after " } else { "" });
    format!(
        "{scene}, {} x {} pixels with {}; {} {plural}, {bits} (digest {}).{} {rounds}. {work}",
        subject.width,
        subject.height,
        rays_each(subject),
        strategies.len(),
        short(reference_digest),
        alone.unwrap_or_default(),
        work = work_sentence(subject)
    )
}

/// Returns a sentence that says whether only threading differs.
pub(super) fn work_sentence(subject: &Subject) -> String {
    if subject.lanes == 1 && !subject.shares_samples() {
        return "Equal work: each traces the same rays, one by one.".to_owned();
    }
    format!("Not equal work: {}.", computed(subject).trim_start_matches("computed: "))
}

/// Returns the bars of a section below their scale, grouped by scheduling.
fn chart(section: &Section<'_>, available: usize) -> Vec<String> {
    let all = || section.rows.iter().chain(&section.failed).copied();
    let longest = all().map(|row| row.measurement.strategy.chars().count()).max().unwrap_or(0);
    let width = longest.min(NAME);
    // More threads than the machine has cannot compute at the same time.
    let scale = section.threads.min(available);
    let middle = if scale.is_multiple_of(2) { (scale / 2).to_string() } else { String::new() };
    let mut lines =
        vec![format!("{:width$}   0{middle:>10}{scale:>10}  speed-up, 95 % interval", "")];
    for (is_fixed, heading) in
        [(false, "scheduled while running"), (true, "equal shares, fixed beforehand")]
    {
        let rows: Vec<&Record> =
            section.rows.iter().copied().filter(|row| is_static(row) == is_fixed).collect();
        let failed: Vec<&Record> =
            section.failed.iter().copied().filter(|row| is_static(row) == is_fixed).collect();
        if rows.is_empty() && failed.is_empty() {
            continue;
        }
        lines.push(heading.to_owned());
        let (alike, behind) = rank(&rows, section.control_error);
        for row in &rows {
            let Some(Interval { median, low, high }) = row.measurement.speedup else { continue };
            let bar = (median / scale as f64 * BAR as f64).round().clamp(0.0, BAR as f64) as usize;
            // The heading is why a row loses to the other group.
            let loses = section.is_certain()
                && behind.iter().any(|(slower, _)| std::ptr::eq(*slower, *row));
            let reason = if loses { reason(row, rows[0]) } else { String::new() };
            let (name, bar) = (clipped(&row.measurement.strategy, width), "=".repeat(bar));
            let line =
                format!("  {name:width$} {bar:BAR$} {median:>5.2}  {low:.2}-{high:.2}   {reason}");
            lines.push(clipped(line.trim_end(), WIDTH));
        }
        if section.is_certain() {
            lines.extend(tile_note(&alike, &behind));
        }
        for row in &failed {
            let name = clipped(&row.measurement.strategy, width);
            lines.push(format!("  {name:width$} {}", failure(row)));
        }
    }
    lines
}

fn failure(row: &Record) -> &'static str {
    match (&row.measurement.error, row.measurement.identical) {
        (Some(_), _) => "FAILED",
        (None, false) => "WRONG IMAGE",
        (None, true) => "no figures: the reference failed",
    }
}

/// Returns why a row may be slower than the best row of its group, if its policy or its counts say
/// so.
fn reason(record: &Record, best: &Record) -> String {
    let (row, other) = (&record.measurement, &best.measurement);
    let mut reasons = Vec::new();
    if let Some((rays, fewer)) = row.primary_rays.zip(other.primary_rays) {
        let times = rays as f64 / fewer.max(1) as f64;
        reasons.extend((times > 1.05).then(|| format!("{times:.1} x the rays")));
    }
    if let Some((lanes, more)) = record.lanes_in_use().zip(best.lanes_in_use()) {
        reasons.extend((lanes < 0.9 * more).then(|| format!("{:.0} % of lanes", lanes * 100.0)));
    }
    if !reasons.is_empty() {
        return reasons.join(", ");
    }
    let (mutex, channel) = (Output::Mutex.to_string(), Output::Channel.to_string());
    if row.output == mutex {
        return format!("{}s, a lock each", row.granularity);
    }
    if row.output == channel {
        return format!("copies each {}", row.granularity);
    }
    String::new()
}

/// Returns a line on the most expensive tile, if it may be why the rows with tiles are behind.
fn tile_note(alike: &[&Record], behind: &[(&Record, Interval)]) -> Option<String> {
    let has_tiles = |row: &&Record| row.measurement.granularity == Granularity::Tile.to_string();
    let slower = behind.iter().map(|(row, _)| *row).find(has_tiles)?;
    let share = slower.largest_tile?;
    let is_limit = share * slower.measurement.threads as f64 > 1.0;
    (is_limit && !alike.iter().any(has_tiles))
        .then(|| format!("  tiles: one tile has {:.0} % of the cost", share * 100.0))
}
