//! The verdict of `rayweave check` as text and as JSON.

use crate::json;
use rayweave_measure::{Machine, Verdict};
use serde::Serialize;
use std::collections::BTreeMap;

/// The schema number of the JSON. It changes when a key is removed or changes its meaning.
const SCHEMA: u32 = 1;

/// The number of findings that the text shows for each strategy.
const SHOWN: usize = 5;

/// Returns the first findings of each strategy, and a last line that sums up.
#[must_use]
pub fn text(verdict: &Verdict) -> String {
    let mut lines = Vec::new();
    let mut counts = BTreeMap::new();
    for finding in &verdict.findings {
        let count = counts.entry(finding.strategy).or_insert(0);
        *count += 1;
        if *count <= SHOWN {
            lines.push(finding.to_string());
        }
    }
    for (strategy, count) in counts.iter().filter(|(_, count)| **count > SHOWN) {
        lines.push(format!("{strategy}: and {} more", count - SHOWN));
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

/// Returns the verdict as a JSON object of schema 1: `schema`, `checked`, `compared`, `findings`,
/// `holds` and `machine`. Keys may be added.
///
/// Each entry of `checked` has `strategies`, `pictures` (`scene`, `width`, `height`), `threads` and
/// `tiles`; each of these was checked with each of the others. A strategy that starts no threads
/// was checked with one. Each entry of `findings` has `strategy`, `threads`, `kind`, `message` and,
/// if it is about an image, `picture`.
#[must_use]
pub fn json(verdict: &Verdict, machine: &Machine) -> String {
    json::text(&CheckDocument { schema: SCHEMA, verdict, holds: verdict.passed(), machine })
}

#[derive(Serialize)]
struct CheckDocument<'a> {
    schema: u32,
    #[serde(flatten)]
    verdict: &'a Verdict,
    holds: bool,
    machine: &'a Machine,
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_measure::check::{Checked, CheckedImage};
    use rayweave_measure::{Fault, Finding, finding};

    fn verdict(findings: usize) -> Verdict {
        let render = finding::CheckedRender {
            scene: "room".to_owned(),
            width: 7,
            height: 3,
            tile: 8,
            repetition: 1,
        };
        let found = |found| Finding {
            strategy: "one",
            threads: 2,
            render: Some(render.clone()),
            fault: Fault::TooManyThreads { expected: 2, found },
        };
        let images = vec![CheckedImage { scene: "room".to_owned(), width: 7, height: 3 }];
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
