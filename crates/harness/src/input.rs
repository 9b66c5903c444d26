//! Loads the scene that the command line asks for.

use crate::files::{Use, claim};
use crate::options::{PrecisionOption, SceneOptions, SwitchOption};
use rayweave_contract::{Image, ImageError, Work};
use rayweave_core::precision::PrecisionEstimate;
use rayweave_core::scene::RenderSettings;
use rayweave_core::{Arithmetic, Execution, Lanes, Precision, Sampling, Scene, tracer};
use rayweave_output::compare::BUILT_IN_SCENE;
use rayweave_scene_file::{self as scene_file, SceneFile};
use std::path::Path;

/// Loads the scene at `path`, or the lab report's. Returns its name in results, too.
pub fn load(path: Option<&Path>) -> Result<(String, SceneFile), String> {
    let Some(path) = path else {
        return Ok((BUILT_IN_SCENE.to_owned(), scene_file::report_scene()));
    };
    let file = scene_file::load(path).map_err(|e| e.to_string())?;
    claim(path, Use::Read)?;
    file.meshes.iter().try_for_each(|mesh| claim(mesh, Use::Read))?;
    Ok((scene_file::path_text(path), file))
}

/// The largest number of pixels of an image in which each may be a recorded piece.
///
/// `explain` keeps 32 bytes for each piece of a strategy's quickest rendering. Three strategies
/// have pixels as pieces, which takes 96 bytes a pixel. The rendering that is being recorded takes
/// 48 bytes a pixel, sorting its gaps 8 and the image 12. This is 164 bytes a pixel in total: 1.4
/// GB for 2^23 pixels.
///
/// `predict` keeps 8 bytes for each 16 pixels of at most 41 renderings, and 16 bytes a pixel of
/// results. This is 37 bytes a pixel: 0.3 GB. One image for each core takes another 0.1 GB.
const MAX_PIXELS: u64 = 1 << 23;

/// A scene with the settings of the command line.
pub struct Input {
    /// The scene's name in results.
    pub name: String,
    pub scene: Scene,
    /// Width of the image in pixels.
    pub width: u32,
    /// Height of the image in pixels.
    pub height: u32,
    pub execution: Execution,
    /// The reason for the precision.
    pub reason: String,
    /// The number of triangles without area, which are left out of the scene's meshes.
    skipped_triangles: usize,
}

impl Input {
    /// Loads the scene at `path`, or the lab report's.
    pub fn load(path: Option<&Path>, options: &SceneOptions) -> Result<Self, String> {
        let share_samples = options.only_way_to_share()?;
        Self::load_sharing(path, options, share_samples)
    }

    /// Loads a scene like [`Input::load`], with `share_samples` instead of the option.
    pub fn load_sharing(
        path: Option<&Path>,
        options: &SceneOptions,
        share_samples: bool,
    ) -> Result<Self, String> {
        let (name, file) = load(path)?;
        let mut scene = file.scene;
        let (width, height) = options.size.unwrap_or((file.image.width, file.image.height));
        scene.render.antialiasing = options.antialiasing.unwrap_or(scene.render.antialiasing);
        scene.render.sampling = options.sampling.into();
        let adaptive = options.adaptive == SwitchOption::On;
        if adaptive && scene.render.sampling != Sampling::Lattice {
            return Err(
                "--adaptive on interpolates the samples of a lattice: use --sampling lattice"
                    .to_owned(),
            );
        }
        scene.render.adaptive = adaptive && scene.render.has_lattice();
        let estimate = PrecisionEstimate::of(&scene);
        let (precision, reason) = match options.precision {
            PrecisionOption::Auto => (estimate.precision(), estimate.to_string()),
            PrecisionOption::F32 => (Precision::F32, "as requested".to_owned()),
            PrecisionOption::F64 => (Precision::F64, "as requested".to_owned()),
        };
        scene.render.arithmetic = Arithmetic { formulas: options.formulas.into(), precision };
        let lanes = options.lanes.unwrap_or_default().or(Lanes::suggested(&estimate));
        let execution = Execution { lanes, share_samples, acceleration: options.accel.into() };
        let skipped_triangles = file.skipped_triangles;
        Ok(Self { name, scene, width, height, execution, reason, skipped_triangles })
    }

    /// Returns the work of rendering the scene at this size.
    pub fn work(&self, width: u32, height: u32) -> Result<Box<dyn Work + Send>, String> {
        self.work_by(self.execution, width, height)
    }

    /// Returns the same work with another execution.
    pub fn work_by(
        &self,
        execution: Execution,
        width: u32,
        height: u32,
    ) -> Result<Box<dyn Work + Send>, String> {
        tracer(&self.scene, width, height, execution).map_err(|e| format!("{}: {e}", self.name))
    }

    /// Returns a black image of the requested size.
    pub fn image(&self) -> Result<Image, String> {
        Image::new(self.width, self.height).map_err(|e: ImageError| e.to_string())
    }

    /// Returns width and height of the image, if memory is enough to record each pixel.
    pub fn recordable_size(&self) -> Result<(u32, u32), String> {
        recordable(self.width, self.height)
    }

    /// Returns two lines on scene and arithmetic, and a third one if triangles are left out.
    pub fn describe(&self) -> String {
        let Self { name, width, height, .. } = self;
        let RenderSettings { antialiasing, sampling, adaptive, .. } = self.scene.render;
        let adaptive = if adaptive { " (adaptive)" } else { "" };
        let scene = format!(
            "{name}, {width} x {height} pixels, antialiasing {antialiasing} by {sampling}{adaptive}"
        );
        [Some(scene), Some(self.arithmetic_line()), self.skipped_line()]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// Returns the line on triangles that are left out, if there are any.
    pub fn skipped_line(&self) -> Option<String> {
        match self.skipped_triangles {
            0 => None,
            1 => Some("1 triangle without area left out".to_owned()),
            several => Some(format!("{several} triangles without area left out")),
        }
    }

    /// Returns the line on formulas, precision and the reason for it.
    pub fn arithmetic_line(&self) -> String {
        let Arithmetic { formulas, precision } = self.scene.render.arithmetic;
        format!("arithmetic: {formulas} formulas in {precision}; {}", self.reason)
    }
}

fn recordable(width: u32, height: u32) -> Result<(u32, u32), String> {
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "{width} x {height} pixels are too many to record each: use a smaller --size, of at \
             most {MAX_PIXELS} pixels"
        ));
    }
    Ok((width, height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_image_in_which_each_pixel_is_recorded() {
        assert_eq!(recordable(4096, 2048), Ok((4096, 2048)));
        let error = recordable(2048, 4097).expect_err("a row more");
        let expected = "2048 x 4097 pixels are too many to record each: use a smaller --size, of \
                        at most 8388608 pixels";
        assert_eq!(error, expected);
        assert!(recordable(65535, 65535).is_err());
    }
}
