//! The part of Wavefront OBJ that a mesh is made of: vertices and faces.
//!
//! Read by hand, because no library keeps to what a scene file promises. `tobj` and `obj-rs` do not say
//! in which line a fault is, and the latter gives up on curves; `obj` and `wavefront_obj` refuse kinds of
//! lines that they do not know; the indices of a face are checked against the whole file rather than
//! against what is above the line; and some compute in `f32`.

use std::ops::ControlFlow;

use glam::DVec3;

use crate::error::{Problem, SceneFileError};
use crate::phrase;

/// What is wrong with an OBJ file, and at which byte.
pub(crate) struct Fault {
    offset: usize,
    message: String,
}

impl Fault {
    /// The error to report about the file of these bytes and this name.
    pub(crate) fn within(self, bytes: &[u8], name: &str) -> SceneFileError {
        // Comments and names may be in any encoding. Only the text before the fault is needed.
        let before = String::from_utf8_lossy(&bytes[..self.offset]);
        Problem::at(before.len(), self.message).within(&before, name)
    }
}

/// Hands every triangle of the file to `add`: face by face, each a fan around its first corner.
pub(crate) fn read(
    bytes: &[u8],
    mut add: impl FnMut([DVec3; 3]) -> Result<(), String>,
) -> Result<(), Fault> {
    let mut vertices = Vec::new();
    // A byte order mark would hide the first line from its keyword.
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    for line in text.split(|&byte| byte == b'\n') {
        let line = line.split(|&byte| byte == b'#').next().unwrap_or_default();
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(keyword) = words.next() else { continue };
        let read = match keyword {
            b"v" => vertex(words).map(|vertex| vertices.push(vertex)),
            b"f" => face(words, &vertices, &mut add),
            _ => Ok(()),
        };
        read.map_err(|(word, message)| {
            let at = word.unwrap_or(keyword);
            let offset = at.first().and_then(|byte| bytes.element_offset(byte)).unwrap_or_default();
            Fault { offset, message }
        })?;
    }
    Ok(())
}
