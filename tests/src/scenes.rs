//! The scenes that the repository comes with.

use rayweave_core::Scene;
use std::path::Path;

/// Their names: those of the files, without the ending.
pub const NAMES: [&str; 3] = ["report", "room", "imbalance"];

/// The scene of this name.
///
/// # Panics
///
/// If there is no such file, or it is not sound.
#[must_use]
pub fn named(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/{name}.toml"));
    rayweave_scene_file::load(&path).expect("a sound scene file").scene
}
