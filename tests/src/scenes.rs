//! The scenes that the repository comes with.

use crate::errata;
use rayweave_core::Scene;
use std::fs;
use std::path::{Path, PathBuf};

/// Their names: those of the files, without the ending.
pub const NAMES: [&str; 3] = ["report", "room", "imbalance"];

/// The scene of this name; that of a hard one is `hard/fan`.
///
/// # Panics
///
/// If there is no such file, or it is not sound.
#[must_use]
pub fn named(name: &str) -> Scene {
    rayweave_scene_file::load(&folder().join(format!("{name}.toml")))
        .expect("a sound scene file")
        .scene
}

/// The names of the scenes that are hard for one thing or another, as the folder has them, sorted.
///
/// # Panics
///
/// If the folder cannot be read or has something else in it.
#[must_use]
pub fn hard() -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| {
        let file = entry.expect("an entry").file_name().into_string().expect("a plain name");
        file.strip_suffix(".toml").expect("a scene file").to_owned()
    };
    let mut names: Vec<_> =
        fs::read_dir(folder().join("hard")).expect("a folder").map(name).collect();
    names.sort();
    names
}

/// Nothing at all, under one light: something to put things into, whose material is number 0.
#[must_use]
pub fn empty() -> Scene {
    let mut scene = errata::shadings().swap_remove(0).scene;
    scene.triangles.clear();
    scene
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes")
}
