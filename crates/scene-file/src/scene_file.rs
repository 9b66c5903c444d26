//! The result of reading a scene file.

use std::path::PathBuf;

use rayweave_core::Scene;
use rayweave_core::scene::SceneFault;

/// Everything that a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The size of the image.
    pub image: ImageSize,
    /// The scene. It obeys [`Scene::check`].
    pub scene: Scene,
    /// The number of triangles that were left out of the scene's meshes because they have no area.
    pub skipped_triangles: usize,
    /// The files of the scene's meshes, in the order of the file.
    pub meshes: Vec<PathBuf>,
}

/// The size of an image in pixels.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct ImageSize {
    /// Pixels in a row, 1..=65535.
    pub width: u32,
    /// Rows, 1..=65535.
    pub height: u32,
}

/// The largest width and height of [`ImageSize`].
pub const MAX_SIDE: u32 = 65535;

impl Default for ImageSize {
    fn default() -> Self {
        Self { width: 500, height: 500 }
    }
}

impl ImageSize {
    /// Checks that both sides are within the model's limits.
    ///
    /// # Errors
    ///
    /// The side that is not.
    pub fn check(&self) -> Result<(), SceneFault> {
        for (key, side) in [("width", self.width), ("height", self.height)] {
            if !(1..=MAX_SIDE).contains(&side) {
                let expected = "an integer in 1..=65535";
                return Err(SceneFault { key, expected, found: side.to_string() });
            }
        }
        Ok(())
    }
}
