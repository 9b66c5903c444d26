//! The errors of a scene file: what is wrong, and where.

use std::fmt;

use thiserror::Error;

use crate::wording;

/// A result whose error is ready to be shown.
pub(crate) type Result<T, E = SceneFileError> = std::result::Result<T, E>;

/// An error of a scene file. Shown as one line:
/// `room.toml:41:10: sphere[2].radius: expected a finite number above 0, found -1`.
///
/// No part of it has a control character or a line break, whatever was in the file.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
#[error("{}: {message}", self.place())]
pub struct SceneFileError {
    /// The file, as the caller named it.
    pub file: String,
    /// The position in the file; `None` when the fault is the whole file, or a key of absurdly many
    /// parts.
    pub position: Option<Position>,
    /// The key at fault with its entry, which counts from 0 within its kind: `sphere[2].radius`.
    /// `None` when the text is not TOML, so that there are no keys.
    pub key: Option<String>,
    /// The expectation and what was found.
    pub message: String,
}

/// A position in a text.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Position {
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1. A tab is one character, a byte order mark none.
    pub column: usize,
}

/// The text of a file, and the name that errors give the file.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) text: &'a str,
}

impl SceneFileError {
    /// Returns an error about the whole file, whatever it contains.
    pub(crate) fn of_file(file: &str, message: &str) -> Self {
        Self {
            file: wording::escaped(file),
            position: None,
            key: None,
            message: wording::escaped(message),
        }
    }

    /// Shows the file, the position and the key, as far as there are any.
    fn place(&self) -> String {
        let mut place = self.file.clone();
        if let Some(position) = self.position {
            place.push_str(&format!(":{position}"));
        }
        if let Some(key) = &self.key {
            place.push_str(&format!(": {key}"));
        }
        place
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

impl Source<'_> {
    /// Returns an error at the byte `offset`. Walks through the text to count lines.
    pub(crate) fn error(self, offset: usize, key: Option<String>, message: &str) -> SceneFileError {
        let before = &self.text[..self.text.floor_char_boundary(offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let position = Position {
            line: before.bytes().filter(|&byte| byte == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        };
        let error = SceneFileError::of_file(self.name, message);
        SceneFileError { position: Some(position), key, ..error }
    }

    /// Returns the error for text that is not TOML. The parser saw it from the byte `start` on.
    pub(crate) fn syntax_error(self, error: &toml::de::Error, start: usize) -> SceneFileError {
        let rule = match error.message() {
            // The message for all that is not a value: two numbers without a comma, no text at all.
            "string values must be quoted, expected literal string" => {
                "expected a value (a string in quotes)"
            }
            // "expected nothing" adds nothing to what was found.
            message => message.trim_end_matches(", expected nothing"),
        };
        let Some(span) = error.span() else {
            return SceneFileError::of_file(self.name, &format!("not valid TOML: {rule}"));
        };
        let (start, end) = (start + span.start, start + span.end);
        self.error(
            start,
            None,
            &format!("not valid TOML: {rule}, found {}", self.found(start, end)),
        )
    }

    /// Shows the text between two bytes, or the rest of the line if it is empty.
    fn found(self, start: usize, end: usize) -> String {
        let start = self.text.floor_char_boundary(start);
        let span = self.text.get(start..end).map(str::trim_end).filter(|span| !span.is_empty());
        match span.or_else(|| self.text[start..].lines().next()) {
            None => "the end of the file".into(),
            Some("") => "the end of the line".into(),
            Some(found) => format!("`{}`", wording::shortened(found)),
        }
    }
}
