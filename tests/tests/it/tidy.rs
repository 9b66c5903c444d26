//! Rules of the repository that no compiler checks.

use std::fs;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Lists every file below `folder` whose name ends so, with its text.
fn files(folder: &str, ending: &str) -> Vec<(String, String)> {
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
        for word in
            ["thread::", "fs::", "time::", "net::", "env::", "process::", "println!", "mul_add"]
        {
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
        // One folder for several strategies has the name that they begin with.
        let is_its = |folder: &String| {
            strategy
                .name()
                .strip_prefix(folder)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
        };
        assert!(strategies.iter().any(is_its), "a folder for {}", strategy.name());
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
        assert!(lints, "{name}: lints");
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

/// Catches a strategy that is too long to read in one sitting, or leaves out what its reader wants
/// to know.
#[test]
fn a_strategy_is_short_and_explains_itself() {
    for (name, text) in files("crates/strategies", "lib.rs") {
        assert!(text.lines().count() <= 120, "{name}: longer than a page or two");
        for question in ["What it decides", "What it costs", "When it is right"] {
            assert!(text.contains(question), "{name}: {question}?");
        }
    }
}

/// Catches a file that has outgrown its purpose and should be split by subject.
#[test]
fn no_file_outgrows_its_purpose() {
    let sources = ["crates", "tests", "benches", "fuzz"].map(|folder| files(folder, ".rs"));
    for (name, text) in sources.into_iter().flatten() {
        let lines = text.lines().count();
        assert!(lines <= 450, "{name}: {lines} lines");
    }
}
