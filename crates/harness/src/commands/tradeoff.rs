//! `rayweave tradeoff`: measures speed and error of every setting of the tracer.

use crate::deliver;
use crate::files::{PendingFile, distinct_files};
use crate::image_file::ImageFormat;
use crate::input;
use crate::options::{all_threads, parse_psnr, parse_size};
use crate::progress::Share;
use crate::{Outcome, print};
use clap::Args;
use rayweave_accuracy::flip;
use rayweave_accuracy::tradeoff::{EXACT, Setting, TradeoffExperiment, TradeoffStudy, timed};
use rayweave_contract::{Image, Plan, Work};
use rayweave_core::Scene;
use rayweave_measure::{Machine, Protocol};
use rayweave_output::tradeoff::TradeoffView;
use rayweave_scene_file::ImageSize;
use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the lab report's scene, which is built in]
    scene: Option<PathBuf>,
    /// Size of the images in pixels, each 1..=65535 [default: the scene's shape with 3600 pixels,
    /// or fewer if rendering is slow]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Recommend the fastest setting with this PSNR or more
    #[arg(long, value_name = "DB", default_value_t = 40.0, value_parser = parse_psnr)]
    target_psnr: f64,
    /// Write every setting as JSON, raw samples included
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write every setting as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a plot as SVG
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write the reference, the images of the Pareto front and of the lab report's setting, and
    /// their differences (FLIP) into this folder
    #[arg(long, value_name = "FOLDER")]
    pictures: Option<PathBuf>,
}

/// The number of pixels of an image, unless `--size` gives another.
const PIXELS: f64 = 3600.0;

/// The longest estimated round. Six of them and the warm-up take less than two minutes.
const ROUND: Duration = Duration::from_secs(12);

/// The protocol: six rounds for a 95 % interval, and up to 20 that fit into a minute.
const PROTOCOL: Protocol = Protocol {
    min_rounds: 6,
    max_rounds: 20,
    budget: Duration::from_secs(60),
    goal: None,
    seed: 1,
};

/// The side of a tile in untimed images, which are small.
const TILE: NonZeroU32 = NonZeroU32::new(8).expect("8 is not 0");

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    let files = [&arguments.json, &arguments.csv, &arguments.svg];
    distinct_files(&[&arguments.scene, &arguments.json, &arguments.csv, &arguments.svg])?;
    let [json, csv, svg] = files.map(|path| path.as_deref().map(PendingFile::create).transpose());
    let (json, csv, svg) = (json?, csv?, svg?);
    let (name, file) = input::load(arguments.scene.as_deref())?;
    // Create the folder and check that it is writable before minutes of measuring.
    let reference_file = arguments.pictures.as_deref().map(reference_file).transpose()?;
    let scene = file.scene;
    let size = arguments.size.map_or_else(|| default_size(&scene, file.image), Ok)?;

    let bar = Share::new();
    bar.show(0.0, "reference");
    let experiment = TradeoffExperiment {
        scene: &scene,
        size,
        strategy: rayweave_registry::reference(),
        protocol: PROTOCOL,
    };
    let study =
        experiment.run(|work| render(work, size), |fraction| bar.show(fraction, "settings"));
    drop(bar);
    let study = study.map_err(|e| format!("{name}: {e}"))?;

    let (width, height) = size;
    let machine = Machine::here();
    let view = TradeoffView {
        scene: &name,
        width,
        height,
        study: &study,
        target_psnr: arguments.target_psnr,
        machine: &machine,
    };
    deliver::all([
        deliver::write(json, || Ok(view.json())),
        deliver::write(csv, || Ok(view.csv())),
        deliver::write(svg, || view.svg()),
        deliver::write(reference_file, || ImageFormat::Png.encode(&study.reference.image)),
        arguments
            .pictures
            .as_ref()
            .map_or(Ok(()), |folder| write_images(folder, &scene, &study, size)),
        print(&format!("{}\n", view.table())),
    ])?;
    Ok(if study.repeatable { Outcome::Passed } else { Outcome::Failed })
}

/// Returns the scene's shape in [`PIXELS`] pixels, or in a half, a quarter ... of them if a round
/// would take longer than [`ROUND`].
fn default_size(scene: &Scene, image: ImageSize) -> Result<(u32, u32), String> {
    let mut pixels = PIXELS;
    let pilot = shrunk(image, PIXELS / 4.0);
    let setting = Setting { arithmetic: EXACT, ..Setting::report(scene.render.max_reflections) };
    let nanoseconds =
        timed(rayweave_registry::reference(), &setting, scene, pilot)?.nanoseconds as f64;
    let per_ray = nanoseconds / (f64::from(pilot.0 * pilot.1 * setting.rays_per_pixel()));
    let rays: u32 = Setting::all(scene).iter().map(Setting::rays_per_pixel).sum();
    let pixel_count = |(width, height): (u32, u32)| f64::from(width) * f64::from(height);
    while pixels > 1.0
        && pixel_count(shrunk(image, pixels)) * f64::from(rays) * per_ray > ROUND.as_nanos() as f64
    {
        pixels /= 2.0;
    }
    Ok(shrunk(image, pixels))
}

/// Returns the shape of `image` in at most `pixels` pixels.
fn shrunk(image: ImageSize, pixels: f64) -> (u32, u32) {
    let (width, height) = (f64::from(image.width), f64::from(image.height));
    let scale = (pixels / (width * height)).sqrt().min(1.0);
    // The short side of a very long image is one pixel, and the long side the rest.
    let side = |side: f64| ((side * scale).floor() as u32).clamp(1, (pixels as u32).max(1));
    (side(width), side(height))
}

/// Renders on all threads.
fn render(work: &dyn Work, (width, height): (u32, u32)) -> Result<Image, String> {
    let mut rendered = Image::new(width, height).map_err(|e| e.to_string())?;
    let plan = Plan { threads: all_threads(), tile: TILE };
    let mut renderer = rayweave_registry::recommended().prepare(plan).map_err(|e| e.to_string())?;
    renderer.render(work, &mut rendered).map_err(|e| e.to_string())?;
    Ok(rendered)
}

fn reference_file(folder: &Path) -> Result<PendingFile, String> {
    fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    PendingFile::create(&folder.join("reference.png"))
}

/// Writes the images worth a look, and their differences from the reference.
fn write_images(
    folder: &Path,
    scene: &Scene,
    study: &TradeoffStudy,
    size: (u32, u32),
) -> Result<(), String> {
    let write = |name: &str, image: &Image| {
        PendingFile::create(&folder.join(name))?.finish(&ImageFormat::Png.encode(image)?)
    };
    let truth = &study.reference.image;
    let own = study.report_row();
    for row in study.rows.iter().filter(|row| row.in_front || row.setting == own.setting) {
        let image = render(&*row.setting.work(scene, size).map_err(|e| e.to_string())?, size)?;
        let name = row.setting.to_string().replace(", ", "-").replace(' ', "-");
        write(&format!("{name}.png"), &image)?;
        write(&format!("{name}-difference.png"), &flip::difference_image(truth, &image))?;
    }
    Ok(())
}
