//! Reading and writing one JSON object a line.

use std::io::{self, BufRead, Write};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Why a file of JSON lines was not read. Lines and columns count from 1.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The line could not be read at all.
    #[error("line {line}: {source}")]
    Io {
        /// The line's number.
        line: usize,
        /// What the system said.
        source: io::Error,
    },
    /// The line is no such object as was expected.
    #[error("line {line}, column {column}: {problem}")]
    Content {
        /// The line's number.
        line: usize,
        /// How many bytes of it had been read; 0 where only the object as a whole is wrong.
        column: usize,
        /// What is wrong, and what was expected.
        problem: String,
    },
}

/// Reads every line as one `T`; empty lines are passed over.
pub(crate) fn read<T: DeserializeOwned>(source: impl BufRead) -> Result<Vec<T>, ReadError> {
    let mut items = Vec::new();
    for (index, text) in source.lines().enumerate() {
        let line = index + 1;
        let text = text.map_err(|source| ReadError::Io { line, source })?;
        if !text.trim().is_empty() {
            items.push(serde_json::from_str(&text).map_err(|error| content_error(line, &error))?);
        }
    }
    Ok(items)
}

/// Writes each item on a line of its own.
pub(crate) fn write<T: Serialize>(mut target: impl Write, items: &[T]) -> io::Result<()> {
    for item in items {
        serde_json::to_writer(&mut target, item)?;
        target.write_all(b"\n")?;
    }
    target.flush()
}

/// The error with the place in the file instead of the place in the line's text.
fn content_error(line: usize, error: &serde_json::Error) -> ReadError {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let problem = text.strip_suffix(&place).unwrap_or(&text).to_owned();
    ReadError::Content { line, column: error.column(), problem }
}
