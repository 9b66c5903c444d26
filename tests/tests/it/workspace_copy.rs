//! A copy of the workspace that a test may change, build and run. All documents whose steps change
//! the workspace are tried in one copy, so that our own crates are compiled once.

use crate::{contributing, lab};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// The parts of the workspace that a copy needs to be built.
const PARTS: [&str; 8] =
    [".cargo", "Cargo.toml", "Cargo.lock", "crates", "benches", "examples", "tests", "scenes"];

/// Catches a document whose steps do not work as they stand there.
#[test]
fn the_documents_steps_work() {
    let copy = WorkspaceCopy::new();
    contributing::the_steps_add_a_strategy(&copy);
    lab::the_breaks_are_found(&copy);
    #[cfg(unix)]
    contributing::without_openmp(&copy);
}

/// A copy of the workspace in a temporary folder.
pub(crate) struct WorkspaceCopy(TempDir);

impl WorkspaceCopy {
    fn new() -> Self {
        share_dependencies();
        let folder = TempDir::new().expect("a temporary folder");
        for part in PARTS {
            copy(&repository().join(part), &folder.path().join(part));
        }
        Self(folder)
    }

    pub(crate) fn path(&self, inside: &str) -> PathBuf {
        self.0.path().join(inside)
    }

    /// Puts `new` in place of `old`, which has to be in the file exactly once.
    pub(crate) fn replace(&self, file: &str, old: &str, new: &str) {
        let path = self.path(file);
        let text = fs::read_to_string(&path).expect("the file");
        assert_eq!(text.matches(old).count(), 1, "{old} in {file}");
        fs::write(path, text.replace(old, new)).expect("written");
    }

    /// Runs Cargo in the copy with these variables in its environment.
    fn cargo(&self, environment: &[(&str, &Path)], arguments: &[&str]) -> Output {
        Command::new(env!("CARGO"))
            // Our own crates have to be built soon here, not to be fast.
            .args(["--config", "profile.dev.opt-level = 0"])
            .args(arguments)
            .envs(environment.iter().copied())
            .current_dir(self.0.path())
            // Beside the folder of this build, whose binary other tests are running.
            .env("CARGO_TARGET_DIR", target_folder().join("workspace-copy"))
            .output()
            .expect("cargo starts")
    }

    /// Builds and runs the copy's `rayweave`. A warning of the compiler is on standard error.
    pub(crate) fn rayweave(&self, environment: &[(&str, &Path)], arguments: &[&str]) -> Output {
        let run = ["run", "--offline", "--quiet", "-p", "rayweave", "--"];
        self.cargo(environment, &[&run, arguments].concat())
    }
}

pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the blocks of `language` in a Markdown text, without the indentation of their list.
pub(crate) fn blocks(text: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}");
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.trim() == fence {
            let indent = line.len() - line.trim_start().len();
            let body = lines.by_ref().take_while(|line| line.trim() != "```");
            blocks.push(
                body.map(|line| line.get(indent..).unwrap_or("").to_owned() + "\n").collect(),
            );
        }
    }
    blocks
}

fn copy(from: &Path, to: &Path) {
    if from.is_dir() {
        fs::create_dir_all(to).expect("a folder");
        for entry in fs::read_dir(from).expect("a folder") {
            let entry = entry.expect("an entry");
            if entry.file_name() != "target" {
                copy(&entry.path(), &to.join(entry.file_name()));
            }
        }
    } else {
        fs::copy(from, to).expect("a file");
    }
}

/// Returns the folder above `debug/deps`, which has this test in it.
fn target_folder() -> PathBuf {
    let test = std::env::current_exe().expect("the test's own path");
    test.ancestors().nth(3).expect("target/debug/deps/test").to_owned()
}

/// Gives the copy the dependencies that are compiled already.
fn share_dependencies() {
    let [from, to] = ["", "workspace-copy"].map(|part| target_folder().join(part).join("debug"));
    for part in ["build", "deps", ".fingerprint"] {
        share(&from.join(part), &to.join(part));
    }
}

/// Puts the files of one folder in another, except those of our own crates. They get a second name,
/// but fingerprints, which Cargo writes, are copied.
fn share(from: &Path, to: &Path) {
    let Ok(entries) = fs::read_dir(from) else { return };
    fs::create_dir_all(to).expect("a folder");
    for entry in entries.map(|entry| entry.expect("an entry")) {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if entry.file_name().to_string_lossy().contains("rayweave") || to.is_file() {
            continue;
        }
        if from.is_dir() {
            share(&from, &to);
        } else if from.components().any(|part| part.as_os_str() == ".fingerprint") {
            copy_with_time(&from, &to);
        } else {
            fs::hard_link(&from, &to).expect("a file with two names");
        }
    }
}

/// Copies a file with its time, by which Cargo knows that it is still good.
fn copy_with_time(from: &Path, to: &Path) {
    fs::copy(from, to).expect("a copy");
    let time = fs::metadata(from).and_then(|file| file.modified()).expect("a time");
    fs::File::options()
        .write(true)
        .open(to)
        .and_then(|file| file.set_modified(time))
        .expect("the same time");
}
