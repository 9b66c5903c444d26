//! Runs the program as a user does.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// The result of a run of the program.
pub struct Run {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
}

pub fn rayweave(folder: &Path, arguments: &str) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_rayweave"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the program starts");
    Run::of(output)
}

/// Runs a successful command with `--json a.json`. Returns its output and the JSON.
pub fn rayweave_json(folder: &Path, arguments: &str) -> (String, Value) {
    let text = rayweave(folder, &format!("{arguments} --json a.json")).expect_success();
    (text, json(&folder.join("a.json")))
}

/// Runs commands that start with `command` and must be refused, each with its part of the message.
pub fn expect_refusals(folder: &Path, command: &str, cases: &[(&str, &str)]) {
    for (arguments, expected) in cases {
        let message = rayweave(folder, &format!("{command} {arguments}")).expect_refusal();
        assert!(message.contains(expected), "{arguments}: {message}");
    }
}

impl Run {
    pub fn of(output: Output) -> Self {
        Self {
            status: output.status.code().expect("the program ends by itself"),
            stdout: String::from_utf8(output.stdout).expect("text"),
            stderr: String::from_utf8(output.stderr).expect("text"),
        }
    }

    pub fn expect_success(self) -> String {
        assert_eq!((self.status, self.stderr.as_str()), (0, ""), "{}", self.stdout);
        self.stdout
    }

    /// Checks for status 2 and an error message alone. Returns the message.
    pub fn expect_refusal(self) -> String {
        assert_eq!((self.status, self.stdout.as_str()), (2, ""), "{}", self.stderr);
        assert!(self.stderr.starts_with("error: "), "{}", self.stderr);
        self.stderr
    }
}

pub fn folder() -> TempDir {
    TempDir::new().expect("a temporary folder")
}

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn scene(name: &str) -> String {
    repository().join("scenes").join(name).display().to_string()
}

pub fn files_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("an entry").file_name().into_string().expect("text")).collect();
    names.sort();
    names
}

pub fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("the file")).expect("JSON")
}
