//! The breaks of docs/lab.md, applied to a copy of the workspace as they stand there.

use crate::tidy::files;
use crate::workspace_copy::{WorkspaceCopy, blocks, repository};
use std::fs;

const BROKEN: &str = "crates/strategies/mutex-rows/src/lib.rs";

/// The exit status of Cargo where a program does not compile.
const NOT_COMPILED: i32 = 101;

fn document(name: &str) -> String {
    fs::read_to_string(repository().join(name)).expect("the document")
}

/// Asserts that each break of the lab applies to the strategy, and shows what the lab promises.
///
/// In a break, blocks of Rust are pairs: the lines before and after. The first line of the block of
/// text is what the program says, or the compiler.
pub(crate) fn the_breaks_are_found(copy: &WorkspaceCopy) {
    let lab = document("docs/lab.md");
    let breaks: Vec<&str> = lab.split("\n### Break ").skip(1).collect();
    // A check fails with 1.
    let statuses = [1, 1, NOT_COMPILED];
    assert_eq!(breaks.len(), statuses.len());
    let right = fs::read_to_string(copy.path(BROKEN)).expect("the strategy");
    for (text, status) in breaks.into_iter().zip(statuses) {
        let text = text.split("\n## ").next().unwrap_or("");
        let title = text.lines().next().unwrap_or("");
        let (changes, said) = (blocks(text, "rust"), blocks(text, "text"));
        assert!(!changes.is_empty() && changes.len().is_multiple_of(2), "{title}");
        for change in changes.chunks(2) {
            copy.replace(BROKEN, &change[0], &change[1]);
        }
        let output = copy.rayweave(&[], &["check", "--strategy", "mutex-rows", "--size", "64x48"]);
        let found = [output.stdout, output.stderr]
            .map(|text| String::from_utf8_lossy(&text).into_owned())
            .concat();
        assert_eq!(output.status.code(), Some(status), "{title}: {found}");
        let promised = said[0].lines().next().expect("a line");
        assert!(found.lines().any(|line| line == promised), "{title}: {promised}\n{found}");
        fs::write(copy.path(BROKEN), &right).expect("written");
    }
}

/// Catches a question without an answer, and an answer to no question.
#[test]
fn each_question_has_an_answer() {
    let numbers = |name| {
        let numbered = |line: &str| {
            line.strip_prefix("**").and_then(|l| l.split_once(".**")).map(|(n, _)| n.to_owned())
        };
        document(name).lines().filter_map(numbered).collect::<Vec<_>>()
    };
    let questions = numbers("docs/lab.md");
    assert!(questions.iter().cloned().eq((1..=questions.len()).map(|n| n.to_string())));
    assert!(questions.len() >= 15, "{questions:?}");
    assert_eq!(questions, numbers("docs/lab-answers.md"));
}

/// Catches an example that the lab names and the repository does not have.
#[test]
fn the_examples_of_the_lab_exist() {
    let lab = document("docs/lab.md");
    let names: Vec<&str> = lab
        .lines()
        .filter_map(|line| line.split_once(" --example "))
        .map(|(_, name)| name)
        .collect();
    assert!(!names.is_empty());
    for name in names {
        assert!(repository().join(format!("examples/{name}.rs")).is_file(), "{name}");
    }
}

/// Catches words of the glossary out of order, twice, or not used any more.
#[test]
fn the_glossary_is_sorted_and_in_use() {
    let glossary = document("docs/glossary.md");
    let words: Vec<String> = glossary
        .lines()
        .filter_map(|line| line.strip_prefix("- **"))
        .filter_map(|line| line.split_once("**"))
        .map(|(word, _)| word.replace('`', "").to_lowercase())
        .collect();
    assert!(words.len() > 40, "{words:?}");
    let letters = |word: &String| word.replace(['#', '&'], "");
    assert!(words.is_sorted_by(|a, b| letters(a) < letters(b)), "{words:?}");

    let files = [files("crates", ".rs"), files("", ".md")].concat();
    let texts: Vec<String> = files
        .iter()
        .filter(|(name, _)| name != "docs/glossary.md")
        .map(|(_, text)| text.to_lowercase())
        .collect();
    for word in words {
        let used = texts.iter().any(|text| contains_word(text, &word));
        assert!(used, "{word} is used nowhere");
    }
}

/// Says whether the word stands in the text alone, not within a longer word.
fn contains_word(text: &str, word: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].ends_with(is_letter) && !text[at + word.len()..].starts_with(is_letter)
    })
}
