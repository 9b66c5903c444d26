//! The list as the first screen: a sentence, what was measured, a bar a row, what the figures
//! teach, and which differences to trust. No line is longer than 80 columns.

use super::lessons::{self, samples_are_shared};
use super::ranking::{Section, distance_from_1, is_static, rank, speedup};
use super::table::{TELLING, computed, goal_line, milliseconds, reference};
use super::{Record, Results, Subject, changes, complaint, control, scenes, short};
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
        lines.extend(sections.iter().map(|section| wrapped(&sentence(section), "")));
        if sections.iter().any(|section| !section.is_certain()) {
            lines.push("The figures are too uncertain to rely on, see below.".to_owned());
        }
        if sections.is_empty() {
            lines.push(format!("Only {} was measured, so nothing is compared.", reference(group)));
        }
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

/// Returns the sentence on which strategies are fastest.
fn sentence(section: &Section<'_>) -> String {
    let on = threads(section.threads);
    let (alike, behind) = section.ranked();
    let Some(&best) = alike.first() else {
        return format!("On {on} no strategy gave figures to compare.");
    };
    let name = &best.measurement.strategy;
    if section.threads == 1 {
        let range = range(&section.rows);
        return format!(
            "On {on} nothing is to be gained: {range} times as fast as the plain loop."
        );
    }
    if !section.pays_off() {
        return format!(
            "On {on} no strategy is seen to be faster than the plain loop on one thread: the best, \
             {name}, is {:.2} times as fast.",
            speedup(best)
        );
    }
    let times = range(&alike);
    let times = format!("{times} times as fast as one thread");
    let others = match &behind[..] {
        [] => String::new(),
        [(record, ratio)] => {
            format!("; {} takes {} longer", record.measurement.strategy, longer(ratio.median))
        }
        several => {
            let least = several.iter().map(|(_, ratio)| ratio.median).fold(f64::MAX, f64::min);
            format!("; the others take at least {} longer", longer(least))
        }
    };
    match (alike.len(), behind.len() + section.failed.len()) {
        (1, 0) => format!("On {on} {name} is {times}."),
        (1, _) => format!("Fastest on {on}: {name}, {times}{others}."),
        (all, 0) => {
            format!("On {on} no difference is seen between the {all} strategies: they are {times}.")
        }
        _ => format!(
            "Fastest on {on}: {}, which cannot be told apart: {times}{others}.",
            names(&alike)
        ),
    }
}

/// Returns the speed-ups of rows, the fastest first.
fn range(rows: &[&Record]) -> String {
    let ends = [rows.last(), rows.first()].map(|row| row.map_or(0.0, |row| speedup(row)));
    let [least, most] = ends.map(|speedup| format!("{speedup:.1}"));
    if most == least { most } else { format!("{least} to {most}") }
}

/// Returns up to three names; of more rows, two names and the number of the others.
pub(super) fn names(rows: &[&Record]) -> String {
    let names: Vec<&str> = rows.iter().map(|row| &*row.measurement.strategy).collect();
    match &names[..] {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [one, two] => format!("{one} and {two}"),
        [one, two, three] => format!("{one}, {two} and {three}"),
        [one, two, others @ ..] => format!("{one}, {two} and {} others", others.len()),
    }
}

/// Returns by how much a time is longer, given its ratio.
pub(super) fn longer(ratio: f64) -> String {
    format!("{:.0} %", (ratio - 1.0) * 100.0)
}

fn threads(threads: usize) -> String {
    if threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") }
}

/// Returns what was measured: image, number of strategies, time of the reference, and rounds.
fn measured(group: &[Record]) -> String {
    let Record { subject, rounds, interrupted, reference_digest, .. } = &group[0];
    let rays = match (u64::from(subject.antialiasing), &*subject.sampling) {
        (0, _) => "one ray each".to_owned(),
        (n, "lattice") if subject.adaptive => format!("up to {} rays each", (2 * n + 1).pow(2)),
        (n, "lattice") => format!("{} rays each", (2 * n + 1).pow(2)),
        (n, _) => format!("{} rays each", n * n + (n + 1) * (n + 1)),
    };
    let ways: BTreeSet<&str> = group.iter().map(|record| &*record.measurement.strategy).collect();
    let bits = if group.iter().all(|record| record.measurement.passed()) {
        "all gave the same bits"
    } else {
        "NOT all gave it, see below"
    };
    let alone = group[0]
        .measurement
        .median_ns
        .map(|ns| format!(" One thread takes {} ms;", milliseconds(ns)));
    let rounds = format!("{}{rounds} rounds", if *interrupted { "interrupted after " } else { "" });
    format!(
        "One image ({}, {} x {} pixels, {rays}), {} ways to compute it: {bits} (digest {}).{} \
         {rounds}. {work}",
        subject.scene,
        subject.width,
        subject.height,
        ways.len(),
        short(reference_digest),
        alone.unwrap_or_default(),
        work = work(subject)
    )
}

/// Returns a sentence that says whether only threading differs.
pub(super) fn work(subject: &Subject) -> String {
    if subject.lanes == 1 && !samples_are_shared(subject) {
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
        [(false, "whoever is free takes the next piece"), (true, "equal shares, fixed beforehand")]
    {
        let rows: Vec<&Record> =
            section.rows.iter().copied().filter(|row| is_static(row) == is_fixed).collect();
        let failed: Vec<&Record> =
            section.failed.iter().copied().filter(|row| is_static(row) == is_fixed).collect();
        if rows.is_empty() && failed.is_empty() {
            continue;
        }
        lines.push(heading.to_owned());
        let (_, behind) = rank(&rows, section.trust);
        for row in &rows {
            let Some(Interval { median, low, high }) = row.measurement.speedup else { continue };
            let bar = (median / scale as f64 * BAR as f64).round().clamp(0.0, BAR as f64) as usize;
            // The heading is why a row loses to the other group.
            let loses = behind.iter().any(|(slower, _)| std::ptr::eq(*slower, *row));
            let reason = if loses { reason(row, rows[0]) } else { String::new() };
            let (name, bar) = (clipped(&row.measurement.strategy, width), "=".repeat(bar));
            let line =
                format!("  {name:width$} {bar:BAR$} {median:>5.2}  {low:.2}-{high:.2}   {reason}");
            lines.push(clipped(line.trim_end(), WIDTH));
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
        return format!("a lock a {}", row.granularity);
    }
    if row.output == channel {
        return format!("copies each {}", row.granularity);
    }
    match record.largest_tile {
        Some(share)
            if row.granularity == Granularity::Tile.to_string()
                && share * row.threads as f64 > 1.0 =>
        {
            format!("a tile has {:.0} %", share * 100.0)
        }
        _ => String::new(),
    }
}

/// Returns which differences to trust, by the reference's time over its own.
fn trust(control: Interval) -> String {
    let far = distance_from_1(control);
    let range = format!("{:.2}-{:.2}", control.low, control.high);
    if !control.contains(1.0) {
        return format!("One thread against itself is {range}, which is not 1: measure again.");
    }
    let advice =
        if far > TELLING { " Measure longer (--time-limit) or on a quieter machine." } else { "" };
    let percent = (far * 100.0).ceil().max(1.0);
    format!("Trust differences above {percent:.0} % (one thread against itself: {range}).{advice}")
}
