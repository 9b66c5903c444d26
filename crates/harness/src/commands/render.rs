//! `rayweave render`: a picture.

use crate::files::{PendingFile, distinct_files};
use crate::image_file::ImageFormat;
use crate::input::Input;
use crate::options::{SceneOptions, TileOption, all_threads, parse_threads, strategy_parser};
use crate::progress::ProgressWork;
use crate::{Outcome, print};
use clap::Args;
use rayweave_contract::{Plan, Strategy, Work};
use rayweave_core::{Analysis, Execution};
use rayweave_measure::machine::Machine;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the report's scene, built in]
    scene: Option<PathBuf>,
    /// Picture to write: .png, .ppm or .exr (linear floats) [default: the scene's name, .png]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Strategy to render with [default: the recommended one]
    #[arg(long, value_name = "NAME", value_parser = strategy_parser())]
    strategy: Option<&'static dyn Strategy>,
    /// Number of computing threads [default: what the machine and its quota allow]
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
    // What has no threads of its own computes on one, whatever was asked for.
    let computing = strategy.threads().computing_threads(threads);
    let mut picture = input.picture()?;
    let begin = Instant::now();
    let work = input.work(input.width, input.height)?;
    let preparing = begin.elapsed().as_secs_f64();
    let mut renderer = strategy.prepare(plan).map_err(|e| e.to_string())?;
    let progress = ProgressWork::new(&*work, picture.pixels().len() as u64);
    // Only where it is seen: the bar takes its share of the time.
    let work: &dyn Work = if progress.is_seen() { &progress } else { &*work };
    let begin = Instant::now();
    let result = renderer.render(work, &mut picture);
    let seconds = begin.elapsed().as_secs_f64();
    progress.finish();
    result.map_err(|e| e.to_string())?;

    file.finish(&format.encode(&picture)?)?;
    let stats = if arguments.stats { stats(&input, preparing)? } else { String::new() };
    print(&format!(
        "{}\n{}, threads: {computing}, {seconds:.6} s, digest {}\n{stats}{}\nwritten to {}\n",
        input.describe(),
        strategy.name(),
        picture.digest().short(),
        rayweave_output::machine::text(&Machine::here()),
        path.display(),
    ))?;
    Ok(Outcome::Passed)
}

/// What of the tracer the scene uses; each line ends.
fn stats(input: &Input, preparing: f64) -> Result<String, String> {
    let analysis =
        Analysis::of(&input.scene, &input.execution).map_err(|e| format!("{}: {e}", input.name))?;
    let Execution { lanes, share_samples, .. } = input.execution;
    let settings = &input.scene.render;
    let shared = settings.has_lattice() && (share_samples || settings.adaptive);
    let lanes = lanes.count(settings.arithmetic.precision);
    let samples = if shared { "shared by the pixels of a tile" } else { "each pixel's own" };
    Ok(format!(
        "{analysis}\npackets: {lanes} rays; samples: {samples}\nprepared in {preparing:.6} s, a tree's building included\n"
    ))
}

/// In the working folder, named after the scene.
fn default_output(scene: Option<&Path>) -> PathBuf {
    let name = scene.and_then(Path::file_name).unwrap_or("report.toml".as_ref());
    Path::new(name).with_extension("png")
}
