//! The document in parts. A parsed document takes some thirty times the memory of its text, so a
//! long one is parsed, read and dropped part by part.
//!
//! A part is cut off before a line `[[sphere]]` or of another kind of entry. What is above such a
//! line is complete, if it is TOML: the line is then a header and begins what could be a document
//! of its own. If it is not TOML by itself, the line may have been within a string of many lines,
//! so the part is tried again with more of the text.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::builder::{ENTRIES, SceneBuilder};
use crate::error::{Result, Source};
use crate::node::{Node, Part};

/// The bytes after which a part is cut off: so few that the parsed part stays in the caches.
const USUAL: usize = 8 << 10;
/// The longest part: parsing it takes 2.5 GB at the worst.
const LONGEST: usize = 32 << 20;

/// Reads the whole document.
pub(crate) fn read(file: Source) -> Result<SceneBuilder> {
    let mut builder = SceneBuilder::default();
    let mut start = 0;
    while start < file.text.len() {
        let (part, document) = parse_part(file, start)?;
        builder.add(&Node::document(part, &document))?;
        start += part.text.len();
    }
    Ok(builder)
}

/// Parses the part of `file` that begins at `start`.
fn parse_part(file: Source<'_>, start: usize) -> Result<(Part<'_>, Spanned<DeValue<'_>>)> {
    let rest = &file.text[start..];
    let mut least = USUAL;
    loop {
        let end = cut(rest, least);
        if end > LONGEST {
            let message =
                format!("no header of an entry within {} MiB: too long to be read", LONGEST >> 20);
            return Err(file.error(start, None, &message));
        }
        let text = &rest[..end];
        match DeTable::parse(text) {
            Ok(table) => {
                let document = Spanned::new(0..0, DeValue::Table(table.into_inner()));
                return Ok((Part { file, start, text }, document));
            }
            Err(error) if end == rest.len() || end >= LONGEST / 2 => {
                return Err(file.syntax_error(&error, start));
            }
            Err(_) => least = (16 * end).min(LONGEST / 2),
        }
    }
}

/// Returns the start of the first line behind `least` bytes that is the header of an entry, or the
/// end.
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
