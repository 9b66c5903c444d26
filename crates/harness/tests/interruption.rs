//! Runs that end early, or whose results have no way out: what was measured is not lost.
#![cfg(target_os = "linux")]

mod program;

use program::{Run, json};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_rayweave");

fn folder() -> TempDir {
    TempDir::new().expect("a temporary folder")
}

/// Starts a comparison of a minute in a process group of its own.
fn start(mut program: Command, folder: &Path, options: &str) -> Child {
    let long = "compare --strategy row-counter --time-limit 60 --json a.json";
    program
        .args(long.split_whitespace().chain(options.split_whitespace()))
        .current_dir(folder)
        .process_group(0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// The processes that get a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum To {
    /// The program and the process of its sample, as from a terminal.
    Group,
    /// The program alone.
    Program,
}

/// Sends a signal to a comparison of a minute when it has started `samples` processes.
fn interrupted_at(samples: usize, options: &str, signal: &str, to: To) -> (Run, Option<Value>) {
    let folder = folder();
    let mut program = start(Command::new(PROGRAM), folder.path(), options);
    let mut seen = BTreeSet::new();
    while seen.len() < samples {
        seen.extend(children_of(program.id()));
        assert!(program.try_wait().expect("its state").is_none(), "it ended by itself");
    }
    kill(signal, program.id(), to);
    let run = Run::of(program.wait_with_output().expect("its output"));
    let file = folder.path().join("a.json");
    (run, file.exists().then(|| json(&file)))
}

fn kill(signal: &str, program: u32, to: To) {
    let receiver = if to == To::Group { format!("-{program}") } else { program.to_string() };
    let sent = Command::new("kill").args([signal, "--", &receiver]).status();
    assert!(sent.expect("kill").success());
}

fn children_of(parent: u32) -> Vec<u32> {
    let processes = fs::read_dir("/proc").expect("/proc").filter_map(Result::ok);
    let numbers = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let is_child = |number: &u32| {
        // "pid (name) state parent ..."; the process may have ended meanwhile.
        let stat = fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
        let rest = stat.rsplit(')').next().unwrap_or_default();
        rest.split_whitespace().nth(1) == Some(&parent.to_string())
    };
    numbers.filter(is_child).collect()
}

const SIGNALS: [(&str, To); 4] =
    [("-INT", To::Group), ("-INT", To::Program), ("-TERM", To::Program), ("-HUP", To::Program)];

/// Catches lost measurements, a signal that is not an interruption, and a sample ended by the same
/// Ctrl-C reported as a failed strategy.
#[test]
fn an_interruption_shows_the_complete_rounds() {
    for (signal, to) in SIGNALS {
        // The reference's image, the warm-up of three rows, six rounds of three, and one more.
        let samples = 1 + 3 + 6 * 3 + 1;
        let (run, object) = interrupted_at(samples, "--size 4x4 --antialiasing 0", signal, to);
        assert_eq!((run.status, run.stderr.as_str()), (130, ""), "{signal} {to:?}: {}", run.stdout);
        let text = run.stdout.replace('\n', " ");
        assert!(text.contains("interrupted after ") && !text.contains("failed"), "{text}");
        let object = object.expect("the file");
        let rounds = object["results"][0]["rounds"].as_u64().expect("a number") as usize;
        assert!(rounds >= 6 && object["results"][0]["interrupted"] == true, "{object}");
        for result in object["results"].as_array().expect("a list") {
            assert_eq!(result["samples_ns"].as_array().map(Vec::len), Some(rounds), "{result}");
            assert!(result["median_ns"].is_u64() && result["error"].is_null(), "{result}");
        }
    }
}

/// Catches an interruption that waits for the end of a sample.
#[test]
fn an_early_interruption_reports_that_there_is_no_table() {
    for (signal, to) in SIGNALS {
        // The first sample would take minutes.
        let (run, object) = interrupted_at(1, "--size 2000x2000 --antialiasing 32", signal, to);
        assert_eq!((run.status, run.stdout.as_str()), (130, ""), "{signal} {to:?}: {}", run.stderr);
        let expected = "error: interrupted after 0 complete rounds; a table needs at least 6: \
                        let it run longer, or use a smaller --size\n";
        assert_eq!((run.stderr.as_str(), object), (expected, None));
    }
}

/// Catches a signal that the caller ignores, as `nohup` does, and that ends the run nevertheless.
#[test]
fn an_ignored_signal_stays_ignored() {
    let folder = folder();
    let mut shell = Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$0\" \"$@\"", PROGRAM]);
    let mut program = start(shell, folder.path(), "--size 2000x2000 --antialiasing 32");
    while children_of(program.id()).is_empty() {
        assert!(program.try_wait().expect("its state").is_none(), "it ended by itself");
    }
    kill("-HUP", program.id(), To::Program);
    kill("-TERM", program.id(), To::Program);
    // A second signal would have ended it by itself, without a word.
    assert_eq!(Run::of(program.wait_with_output().expect("its output")).status, 130);
}

/// Catches samples of another program, or none, after the program's file was replaced.
#[test]
fn a_running_program_needs_its_file_no_more() {
    let folder = folder();
    let copy = folder.path().join("rayweave");
    fs::copy(PROGRAM, &copy).expect("a copy");
    let small = "compare --strategy row-counter --time-limit 1 --size 4x4 --antialiasing 0";
    let mut program = Command::new(&copy);
    program.args(small.split_whitespace()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let program = program.spawn().expect("the program starts");
    fs::remove_file(&copy).expect("removed");
    fs::write(&copy, "another program").expect("written");
    let text = Run::of(program.wait_with_output().expect("its output")).expect_success();
    assert!(text.contains("row-counter") && !text.contains("failed"), "{text}");
}

/// Catches a file that is not written because standard output, or another file, cannot be.
#[test]
fn a_result_is_written_whatever_becomes_of_the_others() {
    let folder = folder();
    let run = |arguments: &str| {
        let full = File::options().write(true).open("/dev/full").expect("a full device");
        let mut program = Command::new(PROGRAM);
        program.args(arguments.split_whitespace()).current_dir(folder.path());
        Run::of(program.stdout(full).output().expect("the program starts"))
    };
    for command in [
        "compare --strategy row-counter --time-limit 1 --size 4x4",
        "check --strategy row-counter --size 4x4",
        "explain --strategy row-counter --time-limit 1 --size 4x4",
        "overhead --strategy row-counter --time-limit 1",
        "predict --strategy row-counter --time-limit 1 --size 4x4",
        "tradeoff --size 2x2",
    ] {
        let ended = run(&format!("{command} --json a.json"));
        assert_eq!(ended.status, 2, "{command}: {}", ended.stderr);
        let expected = "error: cannot write to standard output: No space left on device";
        assert!(ended.stderr.starts_with(expected), "{command}: {}", ended.stderr);
        json(&folder.path().join("a.json"));
        fs::remove_file(folder.path().join("a.json")).expect("it was written");
    }
}
