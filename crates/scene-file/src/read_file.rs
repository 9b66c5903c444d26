//! Reads a file to memory, without waiting for a pipe or filling the memory from a device.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use crate::error::{Result, SceneFileError};

/// The largest file that is read, be it a scene or a mesh: 256 MiB, which is some 3 million spheres
/// or 6 million triangles.
pub const MAX_BYTES: u64 = 256 << 20;

/// Returns the contents of a regular file that is not too large. `name` is what errors call it.
///
/// # Errors
///
/// The file cannot be read, is a device, pipe or folder, or is larger than [`MAX_BYTES`].
pub fn bytes_of(path: &Path, name: &str) -> Result<Vec<u8>> {
    let refusal = |message: &str| SceneFileError::of_file(name, message);
    let unreadable = |error: io::Error| refusal(&format!("cannot be read: {error}"));
    // Asked before opening, because opening a pipe without a writer waits for one.
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(refusal("expected a file, found a folder"));
    }
    if !metadata.is_file() {
        return Err(refusal("expected a regular file, found a device, pipe or socket"));
    }
    let mut bytes = Vec::new();
    if metadata.len() <= MAX_BYTES {
        // The length may be wrong (a growing file, a virtual file system): one byte more tells.
        let file = File::open(path).map_err(unreadable)?;
        file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    }
    if metadata.len().max(bytes.len() as u64) > MAX_BYTES {
        let limit = MAX_BYTES >> 20;
        return Err(refusal(&format!("larger than the {limit} MiB that a file may have")));
    }
    Ok(bytes)
}
