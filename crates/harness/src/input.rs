//! From the options to a scene that is ready to be rendered.

use crate::options::{PrecisionOption, SceneOptions, SwitchOption};
use rayweave_contract::{Image, ImageError, Work};
use rayweave_core::precision::PrecisionEstimate;
use rayweave_core::scene::RenderSettings;
use rayweave_core::{Arithmetic, Execution, Lanes, Precision, Sampling, Scene, tracer};
use rayweave_scene_file::{self as scene_file, SceneFile};
use std::path::Path;

/// The scene at `path`, or the report's, and what results call it.
pub fn load(path: Option<&Path>) -> Result<(String, SceneFile), String> {
    Ok(match path {
        Some(path) => {
            (path.display().to_string(), scene_file::load(path).map_err(|e| e.to_string())?)
        }
        None => ("report (built in)".to_owned(), scene_file::report_scene()),
    })
}

/// The most pixels of a picture where each may be a piece of which a record is kept.
///
/// `explain` keeps 32 bytes of each piece of a strategy's quickest rendering. Three of all
/// strategies deal in pixels: 96 bytes a pixel; tiles are few. While one more rendering is recorded
/// there is room for half as many pieces again, 48 bytes a pixel; then its gaps are sorted, 8
/// bytes; and the picture has 12. Together 164 bytes, of 2^23 pixels 1.4 GB.
///
/// `predict` keeps 8 bytes of 16 pixels for each rendering, of which there are 41 at most where
/// pictures are so large, and twice the 8 bytes a pixel that come of it: 37 bytes a pixel, 0.3 GB.
/// The picture is there once for each core, 0.1 GB.
const MAX_PIXELS: u64 = 1 << 23;

/// A scene with the command line's overrides.
pub struct Input {
    /// What results call it.
    pub name: String,
    pub scene: Scene,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    pub execution: Execution,
    /// Why this precision.
    pub reason: String,
    /// Of the scene's meshes, because they have no area.
    skipped_triangles: usize,
}

impl Input {
    /// Loads the scene at `path`, or takes the report's.
    pub fn load(path: Option<&Path>, options: &SceneOptions) -> Result<Self, String> {
        let share_samples = options.share_samples.single()?;
        Self::load_sharing(path, options, share_samples)
    }

    /// As [`Input::load`], but whether samples are shared is not what the options say.
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
                "--adaptive on: it interpolates the samples of a lattice: take --sampling lattice"
                    .to_owned(),
            );
        }
        scene.render.adaptive = adaptive && scene.render.has_lattice();
        let estimate = PrecisionEstimate::of(&scene);
        let (precision, reason) = match options.precision {
            PrecisionOption::Auto => (estimate.precision(), estimate.to_string()),
            PrecisionOption::F32 => (Precision::F32, "as asked for".to_owned()),
            PrecisionOption::F64 => (Precision::F64, "as asked for".to_owned()),
        };
        scene.render.arithmetic = Arithmetic { formulas: options.formulas.into(), precision };
        let lanes = options.lanes.or(Lanes::suggested(&estimate));
        let execution = Execution { lanes, share_samples, acceleration: options.accel.into() };
        let skipped_triangles = file.skipped_triangles;
        Ok(Self { name, scene, width, height, execution, reason, skipped_triangles })
    }

    /// The work of rendering the scene at this size.
    pub fn work(&self, width: u32, height: u32) -> Result<Box<dyn Work + Send>, String> {
        self.work_by(self.execution, width, height)
    }

    /// The same, executed in another way.
    pub fn work_by(
        &self,
        execution: Execution,
        width: u32,
        height: u32,
    ) -> Result<Box<dyn Work + Send>, String> {
        tracer(&self.scene, width, height, execution).map_err(|e| format!("{}: {e}", self.name))
    }

    /// A black picture of the size asked for.
    pub fn picture(&self) -> Result<Image, String> {
        Image::new(self.width, self.height).map_err(|e: ImageError| e.to_string())
    }

    /// The width and height of the picture, if a record of each pixel can be kept.
    pub fn recordable_size(&self) -> Result<(u32, u32), String> {
        recordable(self.width, self.height)
    }

    /// What is rendered, and how: two lines, and another one if something of it is left out.
    pub fn describe(&self) -> String {
        let Self { name, width, height, .. } = self;
        let RenderSettings { antialiasing, sampling, adaptive, .. } = self.scene.render;
        let adaptive = if adaptive { " (adaptive)" } else { "" };
        let picture = format!(
            "{name}, {width} x {height} pixels, antialiasing {antialiasing} by {sampling}{adaptive}"
        );
        [Some(picture), Some(self.arithmetic_line()), self.skipped_line()]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// What of the scene is left out, if anything.
    pub fn skipped_line(&self) -> Option<String> {
        match self.skipped_triangles {
            0 => None,
            1 => Some("1 triangle without area left out".to_owned()),
            several => Some(format!("{several} triangles without area left out")),
        }
    }

    /// Formulas, precision and its reason.
    pub fn arithmetic_line(&self) -> String {
        let Arithmetic { formulas, precision } = self.scene.render.arithmetic;
        format!("arithmetic: {formulas} formulas in {precision}; {}", self.reason)
    }
}

fn recordable(width: u32, height: u32) -> Result<(u32, u32), String> {
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "{width} x {height} pixels are too many to record each: at most {MAX_PIXELS}, use a smaller --size"
        ));
    }
    Ok((width, height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_picture_of_which_each_pixel_is_recorded() {
        assert_eq!(recordable(4096, 2048), Ok((4096, 2048)));
        let error = recordable(2048, 4097).expect_err("a row more");
        let expected =
            "2048 x 4097 pixels are too many to record each: at most 8388608, use a smaller --size";
        assert_eq!(error, expected);
        assert!(recordable(65535, 65535).is_err());
    }
}
