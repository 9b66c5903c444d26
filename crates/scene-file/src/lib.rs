//! Reads scene files: TOML to a scene, every fault with its file, line, column and key.
//!
//! [`load`] reads a file and the meshes beside it, [`parse`] text that is already there. The types
//! of [`rayweave_core::scene`] say what a scene may contain. This crate knows how the keys are
//! spelled, which of them may be left out, and where in the file each stands.

mod builder;
mod error;
mod keys;
mod material_refs;
mod mesh;
mod node;
mod obj;
mod parts;
mod read_file;
mod scene_file;
mod wording;

pub use error::{Position, SceneFileError};
pub use mesh::MAX_MESH_TRIANGLES;
pub use read_file::{MAX_BYTES, bytes_of};
pub use scene_file::{ImageSize, MAX_SIDE, SceneFile};
pub use wording::path as path_text;

use std::path::Path;

use error::Source;

/// The text of the built-in scene: the final scene of the lab report.
pub const REPORT_SCENE: &str = include_str!("../../../scenes/lab.toml");

/// Returns the scene of [`REPORT_SCENE`].
#[must_use]
pub fn report_scene() -> SceneFile {
    parse(REPORT_SCENE.as_bytes(), "lab.toml")
        .expect("the built-in scene is sound, a test holds it")
}

/// Reads a scene file and the meshes that it names. Its errors call the file by `path`, and a mesh
/// by the folder of `path` and the path in the scene file.
///
/// # Errors
///
/// A path that cannot be read, is not a regular file or is larger than [`MAX_BYTES`]; then
/// everything that [`parse`] refuses. Last come the files of meshes: the same of their paths, then
/// numbers, corners, a mesh without any triangle, or more than [`MAX_MESH_TRIANGLES`] in all.
pub fn load(path: &Path) -> Result<SceneFile, SceneFileError> {
    let name = wording::path(path);
    let bytes = bytes_of(path, &name)?;
    parse_in(path.parent(), &bytes, &name)
}

/// Reads the text of a scene file without meshes. `name` is what its errors call the file.
///
/// The text is UTF-8, with or without a byte order mark. Its lines end with LF or CRLF. Materials
/// are sorted by name; all else keeps the order of the file.
///
/// # Errors
///
/// The first fault found: bytes that are not UTF-8, text that is not TOML, then keys, types and
/// ranges, entry by entry, then references. A `[[mesh]]` is a fault, because text is in no folder.
/// Long text is read in parts, each checked for all of this but the references.
pub fn parse(bytes: &[u8], name: &str) -> Result<SceneFile, SceneFileError> {
    parse_in(None, bytes, name)
}

/// Does the same as [`parse`], with the folder that meshes are in.
fn parse_in(folder: Option<&Path>, bytes: &[u8], name: &str) -> Result<SceneFile, SceneFileError> {
    // The mark is no character of the first line: it must not count as a column.
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    match str::from_utf8(bytes) {
        Ok(text) => {
            let source = Source { name, text };
            parts::read(source)?.finish(source, folder)
        }
        Err(error) => {
            let (valid, rest) = bytes.split_at(error.valid_up_to());
            let byte = rest.first().copied().unwrap_or_default();
            let source = Source { name, text: &String::from_utf8_lossy(valid) };
            Err(source.error(valid.len(), None, &format!("not UTF-8: a byte 0x{byte:02x}")))
        }
    }
}
