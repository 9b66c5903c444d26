//! What is wrong with a scene file, and where.

use std::fmt;
use std::ops::Range;

use thiserror::Error;

use crate::phrase;

/// What is wrong with a scene file. Shown as one line:
/// `room.toml:41:10: sphere[2].radius: expected a finite number above 0, found -1`.
///
/// No part of it has a control character or a line break, whatever was in the file.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
#[error("{}: {message}", self.place())]
pub struct SceneFileError {
    /// The file, as the caller named it.
    pub file: String,
    /// Where in the file; `None` when the fault is the whole file, or a key of absurdly many parts.
    pub position: Option<Position>,
    /// The key at fault with its entry, which counts from 0 within its kind: `sphere[2].radius`.
    /// `None` when the text is no TOML, so that there are no keys.
    pub key: Option<String>,
    /// What was expected and what was found.
    pub message: String,
}

/// A place in a text.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Position {
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1. A tab is one character, a byte order mark none.
    pub column: usize,
}

impl SceneFileError {
    /// A fault of the whole file, whatever it contains.
    pub(crate) fn of_file(file: &str, message: String) -> Self {
        Self {
            file: phrase::escaped(file),
            position: None,
            key: None,
            message: phrase::escaped(&message),
        }
    }

    /// File, position and key, as far as there are any.
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

impl Position {
    /// The position of the byte at `offset`; of the end, if the text is shorter.
    fn of(offset: usize, text: &str) -> Self {
        let before = &text[..text.floor_char_boundary(offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self {
            line: before.bytes().filter(|&byte| byte == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// A fault by its offset in the text. Only the one that is reported gets a line and a column, which
/// cost a walk through the text.
#[derive(Debug)]
pub(crate) struct Problem {
    offset: Option<usize>,
    key: Option<String>,
    message: String,
}

impl Problem {
    /// A fault of the text at `offset`.
    pub(crate) fn at(offset: usize, message: String) -> Self {
        Self { offset: Some(offset), key: None, message }
    }

    /// A fault of the key at `offset`.
    pub(crate) fn of_key(offset: usize, key: String, message: String) -> Self {
        Self { offset: Some(offset), key: Some(key), message }
    }

    /// Text that is not TOML.
    pub(crate) fn syntax(error: &toml::de::Error, text: &str) -> Self {
        let rule = match error.message() {
            // Said of whatever is no value: two numbers without a comma between, no text at all.
            "string values must be quoted, expected literal string" => {
                "expected a value (a string in quotes)"
            }
            // To expect nothing is to say no more than that what was found is wrong.
            message => message.trim_end_matches(", expected nothing"),
        };
        let Some(span) = error.span() else {
            return Self { offset: None, key: None, message: format!("not valid TOML: {rule}") };
        };
        let message = format!("not valid TOML: {rule}, found {}", found(span.clone(), text));
        Self::at(span.start, message)
    }

    /// The same fault, but of a text that is preceded by `start` bytes.
    pub(crate) fn after(self, start: usize) -> Self {
        Self { offset: self.offset.map(|offset| offset + start), ..self }
    }

    /// The same fault with a hint.
    pub(crate) fn adding(self, hint: &str) -> Self {
        Self { message: format!("{}; {hint}", self.message), ..self }
    }

    /// The error to report about `text`, the contents of the file called `name`.
    pub(crate) fn within(self, text: &str, name: &str) -> SceneFileError {
        SceneFileError {
            file: phrase::escaped(name),
            position: self.offset.map(|offset| Position::of(offset, text)),
            key: self.key,
            message: phrase::escaped(&self.message),
        }
    }
}

/// Why a scene is refused: for a fault of its own text, or of a file that it names.
#[derive(Debug)]
pub(crate) enum Refusal {
    Here(Problem),
    There(SceneFileError),
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        Self::Here(problem)
    }
}

impl From<SceneFileError> for Refusal {
    fn from(error: SceneFileError) -> Self {
        Self::There(error)
    }
}

impl Refusal {
    /// The error to report about the scene whose text and name these are.
    pub(crate) fn within(self, text: &str, name: &str) -> SceneFileError {
        match self {
            Self::Here(problem) => problem.within(text, name),
            Self::There(error) => error,
        }
    }
}

/// What stands where the text violates TOML: the span, or the rest of its line if it is empty.
fn found(span: Range<usize>, text: &str) -> String {
    let start = text.floor_char_boundary(span.start);
    let rest = text[start..].lines().next().unwrap_or_default();
    match text
        .get(start..span.end)
        .map(str::trim_end)
        .filter(|there| !there.is_empty())
        .unwrap_or(rest)
    {
        "" if start == text.len() => "the end of the file".into(),
        "" => "the end of the line".into(),
        there => format!("`{}`", phrase::shortened(there)),
    }
}
