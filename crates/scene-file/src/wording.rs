//! Text from a file made fit for a message: on one line, short, and with a suggestion for a typo.

use std::path::Path;

/// The number of characters of an echoed value.
const LONGEST: usize = 60;
/// The number of names in a list of what would be right.
const MOST_NAMES: usize = 10;

/// Returns `text` without anything that a terminal would obey or hide.
pub(crate) fn escaped(text: &str) -> String {
    text.chars().map(printable).collect()
}

/// Returns the path as results and messages show it: control characters, and bytes that are not
/// UTF-8, are escaped.
#[must_use]
pub fn path(path: &Path) -> String {
    let bytes = || path.as_os_str().as_encoded_bytes().escape_ascii().to_string();
    path.to_str().map_or_else(bytes, escaped)
}

/// Returns [`escaped`] text, cut to a length that leaves a message readable.
pub(crate) fn shortened(text: &str) -> String {
    let mut short = String::new();
    let mut left = LONGEST;
    for piece in text.chars().map(printable) {
        match left.checked_sub(piece.chars().count()) {
            Some(rest) => left = rest,
            None => return short + "...",
        }
        short.push_str(&piece);
    }
    short
}

/// Spells a key for a path of keys: bare if it can be, else in quotes.
pub(crate) fn key(name: &str) -> String {
    let bare = |character: char| character.is_ascii_alphanumeric() || "-_".contains(character);
    let short = shortened(name);
    if !name.is_empty() && name.chars().all(bare) { short } else { format!("\"{short}\"") }
}

/// Suggests a name instead of the unknown `name`: the `known` one most like it, else a list.
pub(crate) fn instead(name: &str, known: &[&str]) -> String {
    if let Some(meant) = most_like(name, known) {
        return format!("did you mean `{}`?", key(meant));
    }
    let mut names: Vec<String> =
        known.iter().take(MOST_NAMES).map(|name| format!("`{}`", key(name))).collect();
    if known.len() > MOST_NAMES {
        names.push(format!("... ({} in all)", known.len()));
    }
    if names.is_empty() { "known: none".into() } else { format!("known: {}", names.join(", ")) }
}

/// Returns the printable form of a character. Quotes and backslashes stay: a message is not parsed.
fn printable(character: char) -> String {
    match character {
        '"' | '\'' | '\\' => character.into(),
        // Behind a letter, so that an accent or vowel sign of its own stays.
        _ => format!("x{character}").escape_debug().skip(1).collect(),
    }
}

fn most_like<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let name = name.to_ascii_lowercase();
    known
        .iter()
        // The time is the product of the lengths.
        .filter(|candidate| candidate.len().max(name.len()) <= LONGEST)
        .map(|&known| (strsim::levenshtein(&name, &known.to_ascii_lowercase()), known))
        // Two slips swap two letters. In a short word two slips make another word.
        .filter(|&(slips, known)| slips <= if known.chars().count() < 5 { 1 } else { 2 })
        .min_by_key(|&(slips, _)| slips)
        .map(|(_, known)| known)
}
