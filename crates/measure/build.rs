//! Captures what made this program: the compiler, the target's features and the commit.
//!
//! Whatever cannot be found out is "unknown"; it never fails the build.

use std::env;
use std::path::Path;
use std::process::Command;

/// The sources of the whole program, relative to this package.
const SOURCES: [&str; 3] = ["../../crates", "../../Cargo.toml", "../../Cargo.lock"];

/// The files that git changes when a commit is made or another one is checked out.
const GIT_FILES: [&str; 4] = ["HEAD", "logs/HEAD", "index", "packed-refs"];

fn main() {
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    set("COMPILER", output(&rustc, &["-V"]));
    set("COMMIT", commit());
    set("PROFILE", env::var("PROFILE").ok());
    set("TARGET_FEATURES", env::var("CARGO_CFG_TARGET_FEATURE").ok());
    watch("build.rs");
    SOURCES.iter().for_each(|path| watch(path));
}

fn set(name: &str, value: Option<String>) {
    println!("cargo::rustc-env=RAYWEAVE_{name}={}", value.as_deref().unwrap_or("unknown"));
}

/// Runs this script again when `path` changes. A missing path would run it at every build.
fn watch(path: &str) {
    if Path::new(path).exists() {
        println!("cargo::rerun-if-changed={path}");
    }
}

/// The commit, "-dirty" added when a tracked file differs from it.
fn commit() -> Option<String> {
    // Someone else's repository may hold an unpacked copy of ours: its commit says nothing.
    git(&["ls-files", "--error-unmatch", "Cargo.toml"])?;
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    // `--git-path` knows where these are in a worktree too.
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    for file in GIT_FILES.into_iter().chain(branch.as_deref()) {
        git(&["rev-parse", "--git-path", file]).iter().for_each(|path| watch(path));
    }
    let changes = git(&["status", "--porcelain", "--untracked-files=no"])?;
    Some(if changes.is_empty() { commit } else { commit + "-dirty" })
}

fn git(arguments: &[&str]) -> Option<String> {
    // With its optional locks `git status` would rewrite the index, and so trigger the next build.
    output("git", &[&["--no-optional-locks"], arguments].concat())
}

fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
