//! `rayweave render`: renders an image to a file.

use crate::files::{PendingFile, distinct_files};
use crate::image_file::ImageFormat;
use crate::input::Input;
use crate::options::{SceneOptions, TileOption, all_threads, parse_threads, strategy_parser};
use crate::progress::ProgressWork;
use crate::{Outcome, print, warn};
use clap::Args;
use rayweave_contract::{Image, Plan, Strategy, Work};
use rayweave_core::{Analysis, Execution};
use rayweave_measure::machine::Machine;
use rayweave_scene_file::path_text;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the lab report's scene, which is built in]
    scene: Option<PathBuf>,
    /// Image to write: .png, .ppm or .exr (linear floats) [default: the scene's name with .png]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Strategy to render with [default: the recommended one]
    #[arg(long, value_name = "NAME", value_parser = strategy_parser())]
    strategy: Option<Strategy<'static>>,
    /// Number of computing threads [default: all that the machine and its quota allow]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<NonZeroUsize>,
    #[command(flatten)]
    tile: TileOption,
    /// Print which parts of the tracer the scene uses and how long it took to prepare
    #[arg(long, alias = "explain")]
    stats: bool,
    #[command(flatten)]
    options: SceneOptions,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    let path =
        arguments.output.clone().unwrap_or_else(|| default_output(arguments.scene.as_deref()));
    distinct_files(&[&arguments.scene, &Some(path.clone())])?;
    let format = ImageFormat::of(&path)?;
    let file = PendingFile::create(&path)?;
    let input = Input::load(arguments.scene.as_deref(), &arguments.options)?;

    let strategy = arguments.strategy.unwrap_or_else(rayweave_registry::recommended);
    let threads = arguments.threads.unwrap_or_else(all_threads);
    let plan = Plan { threads, tile: arguments.tile.of(input.width, input.height)? };
    // A strategy without threads of its own computes on one, whatever the request is.
    let computing = strategy.threads.computing_threads(threads);
    let mut image = input.image()?;
    // Reserved until the image is written: memory runs out before the work or not at all.
    let reserved = reserve(format.memory(input.width, input.height)).ok_or_else(|| {
        let (width, height) = (input.width, input.height);
        format!("no memory to write an image of {width} x {height} pixels: choose a smaller size")
    })?;
    let begin = Instant::now();
    let work = input.work(input.width, input.height)?;
    let preparing = begin.elapsed().as_secs_f64();
    let mut renderer = strategy.prepare(plan).map_err(|e| e.to_string())?;
    let progress = ProgressWork::new(&*work, image.pixels().len() as u64);
    // The bar takes time, so it is used only where it is visible.
    let work: &dyn Work = if progress.is_seen() { &progress } else { &*work };
    let begin = Instant::now();
    let result = renderer.render(work, &mut image);
    let seconds = begin.elapsed().as_secs_f64();
    progress.finish();
    result.map_err(|e| e.to_string())?;

    drop(reserved);
    file.finish_with(|file| format.write(&image, file))?;
    if let Some(warning) = not_finite(&image) {
        warn(&warning);
    }
    let stats = if arguments.stats { stats(&input, preparing)? } else { String::new() };
    print(&format!(
        "{}\n{}, threads: {computing}, {seconds:.6} s, digest {}\n{stats}{}\nwritten to {}\n",
        input.describe(),
        strategy.name,
        image.digest().short(),
        rayweave_output::machine::text(&Machine::here()),
        path_text(&path),
    ))?;
    Ok(Outcome::Passed)
}

/// Returns a block of memory of this size, if there is one.
fn reserve(bytes: usize) -> Option<Vec<u8>> {
    let mut block = Vec::new();
    block.try_reserve_exact(bytes).ok()?;
    Some(block)
}

/// Returns the warning that pixels are not finite, if there are any.
fn not_finite(image: &Image) -> Option<String> {
    let pixels = image.pixels().iter().enumerate();
    let mut wrong = pixels.filter(|(_, pixel)| !pixel.iter().all(|channel| channel.is_finite()));
    let (first, _) = wrong.next()?;
    let (x, y) = image.position(first);
    Some(format!(
        "{} of {} pixels are infinite or NaN, the first at ({x}, {y}): use less power of the \
         lights and smaller factors of the materials",
        wrong.count() + 1,
        image.pixels().len(),
    ))
}

/// Returns the parts of the tracer that the scene uses. Each line has a newline at its end.
fn stats(input: &Input, preparing: f64) -> Result<String, String> {
    let analysis =
        Analysis::of(&input.scene, &input.execution).map_err(|e| format!("{}: {e}", input.name))?;
    let Execution { lanes, share_samples, .. } = input.execution;
    let settings = &input.scene.render;
    let shared = settings.has_lattice() && (share_samples || settings.adaptive);
    let lanes = lanes.count(settings.arithmetic.precision);
    let samples = if shared { "shared by the pixels of a tile" } else { "traced by each pixel" };
    Ok(format!(
        "{analysis}\npackets: {lanes} rays; samples: {samples}\n\
         prepared in {preparing:.6} s, acceleration structures included\n"
    ))
}

/// Returns a path in the working folder that is named after the scene.
fn default_output(scene: Option<&Path>) -> PathBuf {
    let name = scene.and_then(Path::file_name).unwrap_or("report.toml".as_ref());
    Path::new(name).with_extension("png")
}
