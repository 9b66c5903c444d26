//! Rules of the repository that no compiler checks.

use std::fs;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Lists every file below `folder` whose name ends so, with its text.
pub(crate) fn files(folder: &str, ending: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![repository().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                let foreign = path.ends_with("target") || path.ends_with(".git");
                folders.extend((!foreign).then_some(path));
            } else if path.to_string_lossy().ends_with(ending) {
                let name = path.strip_prefix(repository()).expect("below").display().to_string();
                let text = fs::read(&path).expect("a file");
                found.push((name, String::from_utf8_lossy(&text).into_owned()));
            }
        }
    }
    found.sort();
    assert!(!found.is_empty(), "{folder}: no {ending}");
    found
}

fn manifests() -> Vec<(String, String)> {
    let mut manifests = files("crates", "Cargo.toml");
    manifests.extend(files("benches", "Cargo.toml"));
    manifests.extend(files("examples", "Cargo.toml"));
    manifests.extend(files("tests", "Cargo.toml"));
    manifests
}

/// Catches a contract or a tracer that starts a thread, opens a file, reads a clock or prints: both
/// have to be the same everywhere.
#[test]
fn contract_and_core_touch_nothing_of_the_machine() {
    let sources = ["crates/contract/src", "crates/core/src"].map(|folder| files(folder, ".rs"));
    for (name, text) in sources.into_iter().flatten() {
        // An example in a comment may start threads.
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        let text: String = code.collect();
        for word in [
            "thread::",
            "fs::",
            "time::",
            "net::",
            "env::",
            "process::",
            "print!(",
            "println!",
            "dbg!",
            "mul_add",
        ] {
            assert!(!text.contains(word), "{name}: {word}");
        }
    }
}

/// Catches strategies, a simulation or a measurement that know the tracer, not only the contract.
#[test]
fn nothing_between_contract_and_accuracy_depends_on_the_tracer() {
    let below =
        ["contract", "thread-team", "rayon-pool", "strategies", "registry", "predict", "measure"];
    for (name, text) in manifests() {
        let apart = below.iter().any(|folder| name.starts_with(&format!("crates/{folder}/")));
        assert!(!(apart && text.contains("rayweave-core")), "{name}: depends on the tracer");
    }
}

/// Catches a strategy that another crate depends on, and would have to be changed there too.
#[test]
fn only_the_registry_names_a_strategy() {
    let strategies: Vec<String> = files("crates/strategies", "Cargo.toml")
        .iter()
        .map(|(name, _)| name.split('/').nth(2).expect("a folder").to_owned())
        .collect();
    for (name, text) in manifests() {
        let is_registry = name.starts_with("crates/registry/");
        for strategy in &strategies {
            let depends = text.contains(&format!("rayweave-{strategy}.workspace"));
            assert_eq!(depends, is_registry, "{name}: rayweave-{strategy}");
        }
    }
    for strategy in rayweave_registry::STRATEGIES {
        // The name of a folder for several strategies is in theirs.
        let is_its = |folder: &String| strategy.name.contains(folder.as_str());
        assert!(strategies.iter().any(is_its), "a folder for {}", strategy.name);
    }
}

/// Catches a crate with a version, lints or a licence of its own.
#[test]
fn members_take_versions_lints_and_licence_from_the_workspace() {
    for (name, text) in manifests() {
        for line in [
            "version.workspace",
            "edition.workspace",
            "rust-version.workspace",
            "license.workspace",
        ] {
            assert!(text.contains(line), "{name}: {line}");
        }
        let lints =
            text.contains("[lints]\nworkspace = true") || text.ends_with(&lints_that_allow_c());
        // A beginner's program prints, and unwraps a lock.
        assert!(lints || name.starts_with("examples/"), "{name}: lints");
        assert!(!text.contains("version = "), "{name}: a version of its own");
    }
}

/// The workspace's lints with one word changed: unsafe code may be allowed in places.
fn lints_that_allow_c() -> String {
    let text =
        fs::read_to_string(repository().join("Cargo.toml")).expect("the workspace's manifest");
    let begin = text.find("[workspace.lints.rust]").expect("lints");
    let (lints, _) = text[begin..].split_once("\n\n[profile").expect("profiles after them");
    lints.replace("[workspace.", "[").replace("unsafe_code = \"forbid\"", "unsafe_code = \"deny\"")
        + "\n"
}

/// Catches two public types of one name, which a reader of the workspace cannot tell apart.
#[test]
fn public_type_names_are_unique() {
    let mut places = std::collections::BTreeMap::<String, Vec<String>>::new();
    for (name, text) in files("crates", ".rs") {
        // A program has no public types.
        if !name.contains("/src/") || name.starts_with("crates/harness/") {
            continue;
        }
        // A test module with a body ends its file.
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or("");
        for line in code.lines() {
            let mut words = line.trim().split(|c: char| !c.is_alphanumeric() && c != '_');
            if words.next() == Some("pub")
                && words.next().is_some_and(|w| ["struct", "enum", "trait", "type"].contains(&w))
                && let Some(item) = words.next()
            {
                places.entry(item.to_owned()).or_default().push(name.clone());
            }
        }
    }
    places.retain(|_, places| places.len() > 1);
    assert!(places.is_empty(), "public types of one name: {places:#?}");
}

/// Catches unsafe code outside of the one module of a crate that calls C.
#[test]
fn unsafe_code_is_only_where_c_is_called() {
    for (name, text) in files("crates", ".rs") {
        let is_unsafe = ["unsafe {", "unsafe fn", "unsafe impl", "unsafe extern"]
            .iter()
            .any(|word| text.contains(word));
        assert_eq!(is_unsafe, name.ends_with("/ffi.rs"), "{name}");
    }
}

/// Catches a strategy that is too long to read in a minute or two, leaves out what its reader wants
/// to know, or has another number than its place among the lessons.
#[test]
fn a_strategy_is_a_short_lesson() {
    let (_, registry) = files("crates/registry", "lib.rs").remove(0);
    let place = |folder: &str| registry.find(&format!("rayweave_{}::", folder.replace('-', "_")));
    let mut lessons: Vec<_> = files("crates/strategies", "lib.rs")
        .into_iter()
        .map(|(name, text)| (place(name.split('/').nth(2).expect("a folder")), name, text))
        .collect();
    lessons.sort();
    for (number, (_, name, text)) in (1..).zip(&lessons) {
        assert!(text.starts_with(&format!("//! Lesson {number}, `")), "{name}: lesson {number}?");
        let labels = ["//! In the lab report: ", "//! In OpenMP: "];
        let counterpart = text.lines().nth(2).expect("a third line");
        assert!(labels.iter().any(|l| counterpart.starts_with(l)), "{name}: one of {labels:?}?");
        for part in ["New", "What it decides", "What it costs", "When it is right"] {
            assert!(text.contains(&format!("//! * **{part}**: ")), "{name}: {part}?");
        }
        assert!(text.lines().count() <= 80, "{name}: longer than a page");
    }
    let mut lines: Vec<usize> = lessons.iter().map(|(_, _, text)| text.lines().count()).collect();
    lines.sort_unstable();
    assert!(
        lines[lines.len() / 2] <= 45,
        "half of the lessons are longer than 45 lines: {lines:?}"
    );
}

/// Words that open a fragment, not a sentence about the item.
const HEADLESS: [&str; 13] = [
    "What", "Whether", "How", "Of", "Those", "That", "As", "In", "Where", "Which", "Who", "Whose",
    "Why",
];

/// Catches a doc comment that does not open with what the item is or does: "What is left",
/// "Whether it fits", "Of each tile", "In pixels". "How to ..." and "In place" are good openings.
#[test]
fn doc_comments_open_with_what_the_item_is_or_does() {
    let mut headless = Vec::new();
    let sources =
        ["crates", "tests", "benches", "examples", "fuzz"].map(|folder| files(folder, ".rs"));
    for (name, text) in sources.into_iter().flatten() {
        let mut previous = "";
        for (number, line) in (1..).zip(text.lines()) {
            let marker = line.trim_start().get(..3).filter(|m| ["///", "//!"].contains(m));
            let opening = marker.is_some_and(|marker| marker != previous);
            previous = marker.unwrap_or("");
            let mut words = line.split_whitespace().skip(1);
            let (Some(first), second) = (words.next(), words.next()) else { continue };
            let good = [("How", "to"), ("In", "place")].contains(&(first, second.unwrap_or("")));
            if opening && HEADLESS.contains(&first) && !good {
                headless.push(format!("{name}:{number}: {}", line.trim()));
            }
        }
    }
    assert!(headless.is_empty(), "doc comments without a subject:\n{}", headless.join("\n"));
}

/// Catches a file that has outgrown its purpose and should be split by subject.
#[test]
fn no_file_outgrows_its_purpose() {
    let sources =
        ["crates", "tests", "benches", "examples", "fuzz"].map(|folder| files(folder, ".rs"));
    for (name, text) in sources.into_iter().flatten() {
        let lines = text.lines().count();
        assert!(lines <= 450, "{name}: {lines} lines");
    }
}

/// Catches a line that does not fit in 100 columns, in code, comments, prose, manifests or shell
/// scripts.
/// Tables and code blocks of Markdown are as wide as they have to be, and so is malformed input.
#[test]
fn no_line_is_wider_than_100_columns() {
    let mut wide = Vec::new();
    for (name, text) in files("", "") {
        let script = text.lines().next().is_some_and(|l| l.starts_with("#!") && l.ends_with("sh"));
        let markdown = name.ends_with(".md");
        if name.contains("/malformed/") {
            continue;
        }
        if !(markdown || script || [".rs", ".toml", ".sh"].iter().any(|end| name.ends_with(end))) {
            continue;
        }
        let mut is_block = false;
        for (number, line) in (1..).zip(text.lines()) {
            let fence = markdown && line.trim_start().starts_with("```");
            is_block ^= fence;
            let table =
                markdown && (line.trim_start().starts_with('|') || line.starts_with("    "));
            if !(is_block || fence || table) && line.chars().count() > 100 {
                wide.push(format!("{name}:{number}"));
            }
        }
    }
    assert!(wide.is_empty(), "wider than 100 columns:\n{}", wide.join("\n"));
}
