//! What a check found, as text and as JSON.

use crate::json;
use rayweave_measure::check::Checked;
use rayweave_measure::{Fault, Finding, Machine, Verdict};
use serde::Serialize;
use std::collections::BTreeMap;

/// The shape of the JSON; it changes when a key changes its meaning or goes.
const SCHEMA: u32 = 1;

/// Findings told of each strategy: enough to see a pattern, and few enough to read.
const TOLD: usize = 5;

/// The findings, the first few of each strategy, and a last line that sums up.
#[must_use]
pub fn text(verdict: &Verdict) -> String {
    let mut lines = Vec::new();
    let mut counts = BTreeMap::new();
    for finding in &verdict.findings {
        let count = counts.entry(finding.strategy).or_insert(0);
        *count += 1;
        if *count <= TOLD {
            lines.push(finding.to_string());
        }
    }
    for (strategy, count) in counts.iter().filter(|(_, count)| **count > TOLD) {
        lines.push(format!("{strategy}: and {} more", count - TOLD));
    }
    let wrong: Vec<String> =
        counts.iter().map(|(strategy, count)| format!("{strategy} ({count} findings)")).collect();
    let sum = if wrong.is_empty() {
        "all identical".to_owned()
    } else {
        format!("WRONG: {}", wrong.join(", "))
    };
    lines.push(format!(
        "{} renderings compared with the reference, bit for bit: {sum}",
        verdict.compared
    ));
    lines.join("\n")
}

/// The whole verdict as a JSON object of schema 1: `schema`, `checked`, `compared`, `holds`,
/// `machine` and `findings`. Keys may be added. Each of `checked` has `strategies`, `pictures`
/// (`scene`, `width`, `height`), `threads` and `tiles`, of which each was checked with each; what
/// starts no thread was checked as one. Each of `findings` has `strategy`, `threads`, `kind`,
/// `message` and, where it is about a picture, `picture`.
#[must_use]
pub fn json(verdict: &Verdict, machine: &Machine) -> String {
    let object = Object {
        schema: SCHEMA,
        checked: verdict.checked.iter().map(Part::new).collect(),
        compared: verdict.compared,
        holds: verdict.passed(),
        machine,
        findings: verdict.findings.iter().map(Item::new).collect(),
    };
    json::text(&object)
}

#[derive(Serialize)]
struct Object<'a> {
    schema: u32,
    checked: Vec<Part<'a>>,
    compared: usize,
    holds: bool,
    machine: &'a Machine,
    findings: Vec<Item<'a>>,
}

#[derive(Serialize)]
struct Part<'a> {
    strategies: &'a [&'static str],
    pictures: Vec<Size<'a>>,
    threads: &'a [usize],
    tiles: &'a [u32],
}

#[derive(Serialize)]
struct Size<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
}

impl<'a> Part<'a> {
    fn new(Checked { strategies, images, threads, tiles }: &'a Checked) -> Self {
        let size = |(scene, width, height): &'a (String, u32, u32)| Size {
            scene,
            width: *width,
            height: *height,
        };
        Self { strategies, pictures: images.iter().map(size).collect(), threads, tiles }
    }
}

#[derive(Serialize)]
struct Item<'a> {
    strategy: &'a str,
    threads: usize,
    kind: &'static str,
    picture: Option<Picture<'a>>,
    message: String,
}

#[derive(Serialize)]
struct Picture<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    tile: u32,
    repetition: usize,
}

impl<'a> Item<'a> {
    fn new(finding: &'a Finding) -> Self {
        Self {
            strategy: finding.strategy,
            threads: finding.threads,
            kind: match finding.fault {
                Fault::Different(_) => "different",
                Fault::NotOnce { .. } => "not-once",
                Fault::Threads { .. } => "threads",
                Fault::Failed(_) => "failed",
            },
            picture: finding.render.as_ref().map(|picture| Picture {
                scene: &picture.scene,
                width: picture.width,
                height: picture.height,
                tile: picture.tile,
                repetition: picture.repetition,
            }),
            message: finding.fault.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_measure::finding;

    fn verdict(findings: usize) -> Verdict {
        let picture = finding::CheckedRender {
            scene: "room".to_owned(),
            width: 7,
            height: 3,
            tile: 8,
            repetition: 1,
        };
        let found = |found| Finding {
            strategy: "one",
            threads: 2,
            render: Some(picture.clone()),
            fault: Fault::Threads { expected: 2, found },
        };
        let images = vec![("room".to_owned(), 7, 3)];
        let checked =
            vec![Checked { strategies: vec!["one"], images, threads: vec![1, 2], tiles: vec![8] }];
        Verdict { checked, compared: 96, findings: (10..10 + findings).map(found).collect() }
    }

    #[test]
    fn text_of_a_success_is_one_line() {
        let expected = "96 renderings compared with the reference, bit for bit: all identical";
        assert_eq!(text(&verdict(0)), expected);
    }

    #[test]
    fn text_tells_the_first_few_and_counts_the_rest() {
        let text = text(&verdict(7));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 7);
        assert_eq!(
            lines[0],
            "one, 2 threads, room 7x3, tiles of 8: computing threads: expected 2, found 10"
        );
        assert_eq!(lines[5], "one: and 2 more");
        assert!(lines[6].ends_with("WRONG: one (7 findings)"));
    }

    #[test]
    fn json_has_every_finding() {
        let value: serde_json::Value =
            serde_json::from_str(&json(&verdict(7), &Machine::here())).expect("JSON");
        assert_eq!((&value["compared"], &value["holds"]), (&96.into(), &false.into()));
        assert_eq!(value["findings"].as_array().map(Vec::len), Some(7));
        let expected = serde_json::json!([{
            "strategies": ["one"],
            "pictures": [{"scene": "room", "width": 7, "height": 3}],
            "threads": [1, 2],
            "tiles": [8],
        }]);
        assert_eq!((&value["schema"], &value["checked"]), (&1.into(), &expected));
        let finding = &value["findings"][6];
        assert_eq!(
            (&finding["kind"], &finding["picture"]["scene"]),
            (&"threads".into(), &"room".into())
        );
        assert_eq!(finding["message"], "computing threads: expected 2, found 16");
        assert!(value["machine"]["compiler"].is_string());
    }
}
