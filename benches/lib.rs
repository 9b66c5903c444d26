//! The loads that the benches spread over threads, one even, one with nearly all of its cost in a
//! corner; and [probes](Probe), scenes whose rays are counted.

mod probes;

pub use probes::{Kind, Probe, Rays};

use rayweave_contract::Work;
use rayweave_core::precision::PrecisionEstimate;
use rayweave_core::{Execution, Scene, tracer};
use rayweave_scene_file as scene_file;
use std::path::Path;

/// A work, its name and the size of its image.
pub struct Load {
    /// The name in those of the benches.
    pub name: &'static str,
    /// The width of the image in pixels.
    pub width: u32,
    /// The height of the image in pixels.
    pub height: u32,
    /// The work to render.
    pub work: Box<dyn Work + Send>,
}

/// Lists both loads.
///
/// # Panics
///
/// The repository's scenes cannot be read.
#[must_use]
pub fn loads() -> [Load; 2] {
    [load("balanced", "room.toml", (250, 250)), load("corner", "imbalance.toml", (250, 250))]
}

/// Reads the repository's scene in this file.
///
/// # Panics
///
/// It cannot be read.
#[must_use]
pub fn scene(file: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(file);
    scene_file::load(&path).unwrap_or_else(|e| panic!("{e}")).scene
}

fn load(name: &'static str, file: &str, (width, height): (u32, u32)) -> Load {
    let scene = scene(file);
    let scene = scene.with_arithmetic(PrecisionEstimate::of(&scene).precision());
    let work =
        tracer(&scene, width, height, Execution::default()).unwrap_or_else(|e| panic!("{e}"));
    Load { name, width, height, work }
}
