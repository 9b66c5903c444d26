//! The document in parts. A parsed document takes some thirty times the room of its text, so a long
//! one is parsed, read and forgotten part by part.
//!
//! A part is cut off before a line `[[sphere]]` or of another kind of entry. What is above such a
//! line is, if it is TOML, complete: the line is then a header and begins what could be a document
//! of its own. If it is not TOML by itself, the line may have been within a string of many lines,
//! so the part is tried again with more of the text.

use toml::de::DeTable;

use crate::draft::{Draft, ENTRIES};
use crate::error::Problem;
use crate::fields::{Fields, Source};

/// The bytes after which a part is cut off: so few that all about them stays in the caches.
const USUAL: usize = 8 << 10;
/// The longest part: parsing it takes 2.5 GB at the worst.
const LONGEST: usize = 32 << 20;

/// Reads the whole document.
pub(crate) fn read(text: &str) -> Result<Draft, Problem> {
    let mut draft = Draft::default();
    let mut start = 0;
    while start < text.len() {
        let (source, table) = part(text, start)?;
        draft.add(&Fields::of_document(source, &table))?;
        start += source.text.len();
    }
    Ok(draft)
}

/// The part of `text` that begins at `start`.
fn part(text: &str, start: usize) -> Result<(Source<'_>, DeTable<'_>), Problem> {
    let rest = &text[start..];
    let mut least = USUAL;
    loop {
        let end = cut(rest, least);
        if end > LONGEST {
            let message =
                format!("no header of an entry within {} MiB: too long to be read", LONGEST >> 20);
            return Err(Problem::at(start, message));
        }
        let part = &rest[..end];
        match DeTable::parse(part) {
            Ok(table) => return Ok((Source { text: part, start }, table.into_inner())),
            Err(error) if end == rest.len() || end >= LONGEST / 2 => {
                return Err(Problem::syntax(&error, part).after(start));
            }
            Err(_) => least = (16 * end).min(LONGEST / 2),
        }
    }
}

/// Where the first line behind `least` bytes begins that is the header of an entry, else the end.
fn cut(text: &str, least: usize) -> usize {
    let mut from = text.floor_char_boundary(least);
    while let Some(newline) = text[from..].find("\n[[") {
        from += newline + 1;
        let line = text[from..].lines().next().unwrap_or_default().trim_end();
        let name = line.strip_prefix("[[").and_then(|line| line.strip_suffix("]]"));
        if name.is_some_and(|name| ENTRIES.contains(&name)) {
            return from;
        }
    }
    text.len()
}
