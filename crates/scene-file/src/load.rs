//! From a path to bytes, without waiting for a pipe or filling the memory from a device.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use crate::{SceneFile, SceneFileError, parse_in};

/// The largest file that is read, be it a scene or a mesh: 256 MiB, which is some 3 million spheres
/// or 6 million triangles.
pub const MAX_BYTES: u64 = 256 << 20;

/// Reads a scene file and the meshes that it names. Its errors call the file by `path`, and a mesh
/// by the folder of `path` and the path in the scene file.
///
/// # Errors
///
/// A path that cannot be read, is no regular file or is larger than [`MAX_BYTES`]; then everything
/// that [`parse`](crate::parse) refuses, and at last the same of the files of meshes and what is
/// wrong in them: numbers, corners, a mesh without any triangle, or more than
/// [`MAX_MESH_TRIANGLES`](crate::MAX_MESH_TRIANGLES) in all.
pub fn load(path: &Path) -> Result<SceneFile, SceneFileError> {
    let name = path.display().to_string();
    let bytes = bytes_of(path).map_err(|message| SceneFileError::of_file(&name, message))?;
    parse_in(path.parent(), &bytes, &name)
}

/// The contents of a regular file that is not too large.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |error: io::Error| format!("cannot be read: {error}");
    // Asked before opening, because to open a pipe without a writer is to wait for one.
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if metadata.is_dir() {
        return Err("expected a file, found a folder".into());
    }
    if !metadata.is_file() {
        return Err("expected a regular file, found a device, pipe or socket".into());
    }
    let too_large = || format!("larger than the {} MiB that a file may have", MAX_BYTES >> 20);
    if metadata.len() > MAX_BYTES {
        return Err(too_large());
    }
    // The length above may be a lie (a growing file, a virtual file system): one byte more tells.
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    let read = file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if u64::try_from(read).is_ok_and(|read| read <= MAX_BYTES) {
        Ok(bytes)
    } else {
        Err(too_large())
    }
}
