//! The steps of CONTRIBUTING.md, "How to add a strategy", work as they stand there, in a copy of
//! the workspace. The same copy serves for a machine whose C compiler has no OpenMP.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The parts of the workspace that a copy needs to be built.
const PARTS: [&str; 8] = [
    ".cargo",
    "Cargo.toml",
    "Cargo.lock",
    "crates",
    "benches",
    "tests",
    "scenes",
    "CONTRIBUTING.md",
];

const STRATEGY: &str = "dealt-rows";

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
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

/// Returns the blocks of `language` in a Markdown text, without the indentation of their list.
fn blocks(text: &str, language: &str) -> Vec<String> {
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

/// Puts `line` after the one line that is `after`.
fn insert(file: &Path, after: &str, line: &str) {
    replace(file, after, &format!("{after}\n{line}"));
}

/// Puts `new` in place of the one line that is `old`.
fn replace(file: &Path, old: &str, new: &str) {
    let text = fs::read_to_string(file).expect("the file");
    let count = text.lines().filter(|found| found.trim() == old).count();
    assert_eq!(count, 1, "{old} in {}", file.display());
    fs::write(file, text.replacen(old, new, 1)).expect("written");
}

fn cargo(workspace: &Path, environment: &[(&str, &Path)], arguments: &[&str]) -> Output {
    Command::new(env!("CARGO"))
        // Our own crates have to be built soon here, not to be fast.
        .args(["--config", "profile.dev.opt-level = 0"])
        .args(arguments)
        .envs(environment.iter().copied())
        .current_dir(workspace)
        // Beside the folder of this build, whose binary other tests are running.
        .env("CARGO_TARGET_DIR", target_folder().join("contributing"))
        .output()
        .expect("cargo starts")
}

/// Returns the folder above `debug/deps`, which has this test in it.
fn target_folder() -> PathBuf {
    let test = std::env::current_exe().expect("the test's own path");
    test.ancestors().nth(3).expect("target/debug/deps/test").to_owned()
}

/// Gives the copy the dependencies that are compiled already.
fn share_dependencies() {
    let [from, to] = ["", "contributing"].map(|part| target_folder().join(part).join("debug"));
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

/// Returns the output of the workspace's `rayweave`, built in this environment without a warning.
fn run(workspace: &Path, environment: &[(&str, &Path)], arguments: &[&str]) -> String {
    let build = ["run", "--offline", "--quiet", "-p", "rayweave", "--"];
    let output = cargo(workspace, environment, &[&build, arguments].concat());
    let (out, err) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{arguments:?}: {out}{err}");
    assert_eq!(err, "", "{arguments:?}");
    out.into_owned()
}

/// Catches a contract that changed under its description, and any place besides the registry that
/// has to know a strategy.
#[test]
fn the_steps_add_a_strategy() {
    share_dependencies();
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let workspace = folder.path();
    for part in PARTS {
        copy(&repository().join(part), &workspace.join(part));
    }
    let text = fs::read_to_string(workspace.join("CONTRIBUTING.md")).expect("the document");
    let ([manifest, dependency, member_dependency], [source, registry_line]) =
        (&blocks(&text, "toml")[..], &blocks(&text, "rust")[..])
    else {
        panic!("three blocks of TOML and two of Rust");
    };

    let strategy = workspace.join("crates/strategies").join(STRATEGY);
    fs::create_dir_all(strategy.join("src")).expect("a folder");
    fs::write(strategy.join("Cargo.toml"), manifest).expect("written");
    fs::write(strategy.join("src/lib.rs"), source).expect("written");
    insert(&workspace.join("Cargo.toml"), "# One line a strategy.", dependency.trim());
    insert(
        &workspace.join("crates/registry/Cargo.toml"),
        "[dependencies]",
        member_dependency.trim(),
    );
    // At the end of the slice.
    replace(&workspace.join("crates/registry/src/lib.rs"), "];", &format!("{registry_line}];"));

    let rayweave = |arguments: &[&str]| run(workspace, &[], arguments);
    assert!(rayweave(&["strategies"]).lines().any(|line| line.starts_with(STRATEGY)));
    let check = rayweave(&["check", "--strategy", STRATEGY, "--size", "64x48"]);
    assert!(check.contains("all identical"), "{check}");

    #[cfg(unix)]
    without_openmp(workspace);
}

/// Asserts that a build by a compiler that knows no OpenMP has the other strategies.
#[cfg(unix)]
fn without_openmp(workspace: &Path) {
    use std::os::unix::fs::PermissionsExt;
    let compiler = workspace.join("cc-without-openmp");
    let script =
        "#!/bin/sh\nfor word; do [ \"$word\" != -fopenmp ] || exit 1; done\nexec cc \"$@\"\n";
    fs::write(&compiler, script).expect("written");
    fs::set_permissions(&compiler, fs::Permissions::from_mode(0o755)).expect("permitted");

    let rayweave = |arguments: &[&str]| run(workspace, &[("CC", &compiler)], arguments);
    let list = rayweave(&["strategies"]);
    let reason = format!(
        "built without OpenMP: the C compiler {} does not know -fopenmp",
        compiler.display()
    );
    assert_eq!(list.matches(&reason).count(), 3, "{list}");
    let named = "run --offline --quiet -p rayweave -- render --strategy openmp-guided";
    let named: Vec<_> = named.split(' ').collect();
    let refused = cargo(workspace, &[("CC", &compiler)], &named);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&refused.stderr).contains(&format!("unavailable here: {reason}"))
    );

    let check = rayweave(&["check", "--size", "4x3", "--threads", "2", "--tile", "2"]);
    assert!(check.contains("all identical"), "{check}");
    let left_out =
        "left out because unavailable here: openmp-static, openmp-dynamic, openmp-guided ";
    assert!(check.contains(left_out), "{check}");
}
