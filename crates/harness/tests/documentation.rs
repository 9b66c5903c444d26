//! Runs every command that the documents show, so that none of them becomes outdated.

use rayweave_registry::STRATEGIES;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

const DOCUMENTS: [&str; 11] = [
    "README.md",
    "ARCHITECTURE.md",
    "METHODOLOGY.md",
    "CONTRIBUTING.md",
    "docs/glossary.md",
    "docs/lab.md",
    "docs/lab-answers.md",
    "docs/methodology-studies.md",
    "docs/numerics.md",
    "docs/performance.md",
    "docs/strategies.md",
];

/// Commands about the whole repository: CI runs them (`.ci/run`), a test cannot.
const RUN_BY_CI: [&str; 4] = ["cargo run --release", "cargo test", "cargo bench", ".ci/run"];

/// Commands that other tests cover, and fuzzing, which has no end.
const RUN_ELSEWHERE: [&str; 3] = ["dealt-rows", "--example ", "cargo fuzz"];

/// The folder of stored results.
const RESULTS: &str = "docs/results";

/// The file of cases that the documents' commands read, and its name there.
const CASES: (&str, &str) = ("crates/accuracy/corpus/hard-cases.jsonl", "cases.jsonl");

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the commands in the blocks of shell code, without comments, and those in tables.
fn commands(document: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut inside = false;
    for line in document.lines().map(str::trim) {
        match line.strip_prefix("```") {
            Some(language) => inside = language == "sh",
            None if inside => commands.push(line.split('#').next().unwrap_or("").trim().to_owned()),
            None if line.starts_with('|') => {
                let code = line.split('`').skip(1).step_by(2);
                commands.extend(code.filter(|c| c.starts_with("cargo run ")).map(str::to_owned));
            }
            None => {}
        }
    }
    commands.retain(|command| !command.is_empty());
    commands
}

/// Returns the arguments with a small size and a short time. The test only checks that the command
/// succeeds.
fn small(arguments: &str) -> String {
    let takes_size = ["render", "check", "compare", "tradeoff", "explain", "predict", "-"]
        .iter()
        .any(|word| arguments.starts_with(word));
    if arguments.starts_with("tradeoff") {
        // Its reference takes thousands of rays a pixel.
        return format!("{} --size 4x3", arguments.replace("--size 60x60", ""));
    }
    let mut small = arguments.to_owned();
    if takes_size && !small.contains("--size") {
        small += " --size 24x18";
    }
    if ["compare", "explain", "overhead", "predict", "-"]
        .iter()
        .any(|word| arguments.starts_with(word))
    {
        small += " --time-limit 1";
    }
    small
}

#[test]
fn the_documents_commands_work() {
    let folder = TempDir::new().expect("a temporary folder");
    for scenes in ["scenes", "scenes/hard", "scenes/loads"] {
        fs::create_dir(folder.path().join(scenes)).expect("a folder");
        let entries = fs::read_dir(repository().join(scenes))
            .expect("the scenes")
            .map(|e| e.expect("an entry"));
        for entry in entries.filter(|entry| entry.path().is_file()) {
            fs::copy(entry.path(), folder.path().join(scenes).join(entry.file_name()))
                .expect("copied");
        }
    }
    fs::copy(repository().join(CASES.0), folder.path().join(CASES.1)).expect("copied");
    for document in DOCUMENTS {
        let text = fs::read_to_string(repository().join(document)).expect("the document");
        let commands = commands(&text);
        let has_block = text.contains("```sh\n");
        assert!(!(has_block && commands.is_empty()), "{document}: no command was found");
        for command in commands {
            let is_run_by_ci = RUN_BY_CI.iter().any(|known| command == *known)
                || command.starts_with("cargo bench ")
                || RUN_ELSEWHERE.iter().any(|known| command.contains(known));
            if is_run_by_ci {
                continue;
            }
            let arguments = command
                .strip_prefix("cargo run --release -- ")
                .unwrap_or_else(|| panic!("{document}: no test runs `{command}`"));
            let output = Command::new(env!("CARGO_BIN_EXE_rayweave"))
                .args(small(arguments).split_whitespace())
                .current_dir(folder.path())
                .output()
                .expect("the program starts");
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            // The command shows that the textbook formulas are wrong in some cases.
            let expected =
                i32::from(arguments.starts_with("intersect") && arguments.contains("textbook"));
            let status = output.status.code();
            assert!(status == Some(expected) && said.is_empty(), "{document}: `{command}`: {said}");
        }
    }
}

#[test]
fn nothing_is_left_to_fill_in() {
    for document in DOCUMENTS {
        let text = fs::read_to_string(repository().join(document)).expect("the document");
        let left = text.lines().find(|line| line.starts_with('@') || line.contains("TODO"));
        assert_eq!(left, None, "{document}");
    }
}

#[test]
fn the_documents_links_lead_somewhere() {
    for document in DOCUMENTS {
        let text = fs::read_to_string(repository().join(document)).expect("the document");
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let pictures = text.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next());
        for link in links.chain(pictures) {
            if !link.contains("://") && !link.starts_with('#') {
                let folder =
                    repository().join(document).parent().expect("a file is in a folder").to_owned();
                assert!(folder.join(link).exists(), "{document}: {link}");
            }
        }
    }
}

/// Catches a stored first screen of an earlier program.
#[test]
fn the_stored_first_screen_is_todays() {
    let text = stored("first-screen.txt");
    let first = text.lines().next().unwrap_or("");
    assert!(["Fastest on ", "On "].iter().any(|start| first.starts_with(start)), "{first}");
    let wide: Vec<&str> = text.lines().filter(|line| line.chars().count() > 80).collect();
    assert!(wide.is_empty(), "wider than 80 columns: {wide:#?}");
}

/// Catches figures that lack a strategy, or have the order of an earlier registry.
#[test]
fn the_stored_figures_are_of_the_registrys_strategies() {
    let entries = fs::read_dir(repository().join(RESULTS)).expect("the results");
    let names = entries.map(|e| e.expect("an entry").file_name().into_string().expect("UTF-8"));
    let tables: Vec<String> = names.filter(|name| name.ends_with(".csv")).collect();
    assert!(!tables.is_empty());
    for name in tables {
        let text = stored(&name);
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let titles = lines.next().expect("titles");
        let column = |title| titles.iter().position(|t| *t == title).expect("the column");
        let (strategy, control) = (column("strategy"), column("control"));
        let found: Vec<&str> =
            lines.filter(|line| line[control] == "false").map(|line| line[strategy]).collect();
        let expected: Vec<&str> = STRATEGIES.iter().map(|strategy| strategy.name).collect();
        assert_eq!(found, expected, "{name}");
    }
}

/// Catches a stored list of strategies that is not what the program prints.
#[test]
fn the_stored_list_of_strategies_is_the_programs() {
    let output = Command::new(env!("CARGO_BIN_EXE_rayweave"))
        .arg("strategies")
        .output()
        .expect("the program starts");
    let printed = String::from_utf8(output.stdout).expect("UTF-8");
    let (printed, stored) = (listed(&printed), listed(&stored("strategies.txt")));
    assert_eq!(printed.len(), STRATEGIES.len());
    assert_eq!(printed.len(), stored.len());
    for (printed, stored) in printed.iter().zip(&stored) {
        if !printed.contains("  unavailable here: ") {
            assert_eq!(printed, stored);
        }
    }
}

/// Returns the entries of a list of strategies: a line that begins with a name, and the indented
/// lines below it.
fn listed(text: &str) -> Vec<String> {
    let mut entries: Vec<String> = Vec::new();
    for line in text.lines() {
        match entries.last_mut() {
            Some(entry) if line.starts_with(' ') => *entry += &format!("{line}\n"),
            _ => entries.push(format!("{line}\n")),
        }
    }
    entries
}

fn stored(name: &str) -> String {
    fs::read_to_string(repository().join(RESULTS).join(name)).expect("a stored result")
}

/// Catches a table, screen or picture in a document that is not the stored one, and a document that
/// was not spliced after a change of a strategy's source.
#[test]
fn the_documents_show_their_stored_results() {
    let output = Command::new("bash")
        .args(["scripts/refresh", "--check"])
        .current_dir(repository())
        .output()
        .expect("bash starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*said), (Some(0), ""));
}
