//! Reads scene files: TOML to a scene, every fault with its file, line, column and key.
//!
//! [`load`] reads a file and the meshes beside it, [`parse`] text that is already there. What a
//! scene may contain is said by the types of [`rayweave_core::scene`]; this crate knows how the
//! keys are spelled, which of them may be left out, and where in the file each stands.

mod draft;
mod error;
mod fields;
mod load;
mod mesh;
mod obj;
mod parts;
mod phrase;
mod scene;

pub use error::{Position, SceneFileError};
pub use load::{MAX_BYTES, load};
pub use mesh::MAX_MESH_TRIANGLES;
pub use scene::{ImageSize, MAX_SIDE, SceneFile};

use std::path::Path;

use error::Problem;

/// The text of the scene that is built in: the final scene of the lab report.
pub const REPORT_SCENE: &str = include_str!("../../../scenes/report.toml");

/// The scene of [`REPORT_SCENE`].
#[must_use]
pub fn report_scene() -> SceneFile {
    parse(REPORT_SCENE.as_bytes(), "report.toml")
        .expect("the built-in scene is sound, a test holds it")
}

/// Reads the text of a scene file without meshes. `name` is what its errors call the file.
///
/// The text is UTF-8, with or without a byte order mark, its lines ended by LF or CRLF. Materials
/// are sorted by name; all else keeps the order of the file.
///
/// # Errors
///
/// The first fault found: bytes that are not UTF-8, text that is not TOML, then keys, types and
/// ranges, entry by entry, then references. A `[[mesh]]` is a fault, because text is in no folder.
/// Long text is looked at in parts, each for all of this but the references.
pub fn parse(bytes: &[u8], name: &str) -> Result<SceneFile, SceneFileError> {
    parse_in(None, bytes, name)
}

/// [`parse`], with the folder that meshes are in.
fn parse_in(folder: Option<&Path>, bytes: &[u8], name: &str) -> Result<SceneFile, SceneFileError> {
    // The mark is no character of the first line: it must not count as a column.
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => {
            let draft = parts::read(text).map_err(|problem| problem.within(text, name))?;
            draft.finish(folder).map_err(|refusal| refusal.within(text, name))
        }
        Err(error) => {
            let (valid, rest) = bytes.split_at(error.valid_up_to());
            let byte = rest.first().copied().unwrap_or_default();
            let problem = Problem::at(valid.len(), format!("not UTF-8: a byte 0x{byte:02x}"));
            Err(problem.within(&String::from_utf8_lossy(valid), name))
        }
    }
}
