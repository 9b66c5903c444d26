//! Files of JSON lines: one object per line, read and written.

use std::io::{self, BufRead, Write};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// The error of reading a file of JSON lines. Lines and columns count from 1.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The system could not read the line.
    #[error("line {line}: {source}")]
    Io {
        /// The number of the line.
        line: usize,
        /// The error of the system.
        source: io::Error,
    },
    /// The line is not an object of the expected form.
    #[error("line {line}, column {column}: {problem}")]
    Content {
        /// The number of the line.
        line: usize,
        /// The number of bytes read before the error; 0 where only the object as a whole is wrong.
        column: usize,
        /// The problem, and the expected content.
        problem: String,
    },
}

/// Reads each line as one `T`, and skips empty lines.
///
/// # Errors
///
/// The first line that cannot be read as a `T`, with its number and the expected content.
pub fn read<T: DeserializeOwned>(source: impl BufRead) -> Result<Vec<T>, ReadError> {
    let mut items = Vec::new();
    for (index, text) in source.lines().enumerate() {
        let line = index + 1;
        let text = text.map_err(|source| ReadError::Io { line, source })?;
        // Some editors begin a file with a byte order mark.
        let text = if index == 0 { text.trim_start_matches('\u{feff}') } else { &text };
        if !text.trim().is_empty() {
            items.push(serde_json::from_str(text).map_err(|error| content_error(line, &error))?);
        }
    }
    Ok(items)
}

/// Writes each item on a line of its own.
///
/// # Errors
///
/// Errors of `target`.
pub fn write<T: Serialize>(mut target: impl Write, items: &[T]) -> io::Result<()> {
    for item in items {
        serde_json::to_writer(&mut target, item)?;
        target.write_all(b"\n")?;
    }
    target.flush()
}

/// Replaces the place in the line's text by the place in the file.
fn content_error(line: usize, error: &serde_json::Error) -> ReadError {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let problem = text.strip_suffix(&place).unwrap_or(&text).to_owned();
    ReadError::Content { line, column: error.column(), problem }
}
