//! `rayweave error`: speed against error.

use crate::input;
use crate::options::{all_threads, parse_psnr, parse_size};
use crate::output::{PendingFile, distinct_files};
use crate::picture::Format;
use crate::{Outcome, print, progress};
use clap::Args;
use rayweave_accuracy::flip;
use rayweave_accuracy::tradeoff::{Experiment, Study};
use rayweave_core::{Image, Plan, Scene, Work, tracer};
use rayweave_measure::{Machine, Protocol};
use rayweave_report::tradeoff::Report;
use rayweave_scene_file::ImageSize;
use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the report's scene, built in]
    scene: Option<PathBuf>,
    /// Size of the pictures in pixels, each 1..=65535 [default: the scene's shape in 4096 pixels]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Name the fastest setting with this PSNR or more
    #[arg(long, value_name = "DB", default_value_t = 40.0, value_parser = parse_psnr)]
    target_psnr: f64,
    /// Write every setting as JSON, raw samples included
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write every setting as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a plot
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write the reference, the pictures of the Pareto front and of the report's own setting, and
    /// their differences (FLIP) into this folder
    #[arg(long, value_name = "FOLDER")]
    pictures: Option<PathBuf>,
}

/// As many as let all settings be measured six times in a minute or so.
const PIXELS: f64 = 4096.0;

/// Six rounds, for a 95 % interval, and no more of them than fit into a minute.
const PROTOCOL: Protocol =
    Protocol { min_rounds: 6, max_rounds: 20, budget: Duration::from_secs(60), seed: 1 };

/// The side of a tile of an untimed picture: small, because the pictures are.
const TILE: NonZeroU32 = NonZeroU32::new(8).expect("8 is not 0");

/// Steps of the progress bar.
const STEPS: f64 = 1000.0;

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    let files = [&arguments.json, &arguments.csv, &arguments.svg];
    distinct_files(&files)?;
    let [json, csv, svg] = files.map(|path| path.as_deref().map(PendingFile::create).transpose());
    let (json, csv, svg) = (json?, csv?, svg?);
    if let Some(folder) = &arguments.pictures {
        fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    }
    let (name, file) = input::load(arguments.scene.as_deref())?;
    let (scene, size) = (file.scene, arguments.size.unwrap_or_else(|| shrunk(file.image)));

    let bar = progress::bar(STEPS as u64);
    bar.set_message("reference");
    let experiment =
        Experiment { scene: &scene, size, strategy: rayweave_registry::reference(), protocol: PROTOCOL };
    let study = experiment.run(
        |work| render(work, size),
        |fraction| {
            bar.set_message("settings");
            bar.set_position((fraction * STEPS) as u64);
        },
    );
    bar.finish_and_clear();
    let study = study.map_err(|e| format!("{name}: {e}"))?;

    let (width, height) = size;
    let machine = Machine::here();
    let report = Report {
        scene: &name,
        width,
        height,
        study: &study,
        target_psnr: arguments.target_psnr,
        machine: &machine,
    };
    print(&format!("{}\n", report.table()))?;
    json.map_or(Ok(()), |file| file.finish(report.json().as_bytes()))?;
    csv.map_or(Ok(()), |file| file.finish(report.csv().as_bytes()))?;
    svg.map_or(Ok(()), |file| file.finish(report.svg()?.as_bytes()))?;
    arguments.pictures.as_deref().map_or(Ok(()), |folder| write_pictures(folder, &scene, &study, size))?;
    Ok(if study.repeatable { Outcome::Held } else { Outcome::Failed })
}

/// The scene's shape in [`PIXELS`] pixels or a few less.
fn shrunk(image: ImageSize) -> (u32, u32) {
    let (width, height) = (f64::from(image.width), f64::from(image.height));
    let scale = (PIXELS / (width * height)).sqrt().min(1.0);
    let side = |side: f64| ((side * scale).floor() as u32).max(1);
    (side(width), side(height))
}

/// On all threads.
fn render(work: &dyn Work, (width, height): (u32, u32)) -> Result<Image, String> {
    let mut picture = Image::new(width, height).map_err(|e| e.to_string())?;
    let plan = Plan { threads: all_threads(), tile: TILE };
    let mut renderer = rayweave_registry::recommended().prepare(plan).map_err(|e| e.to_string())?;
    renderer.render(work, &mut picture).map_err(|e| e.to_string())?;
    Ok(picture)
}

/// The truth, then what is worth a look: the picture and its difference from the truth.
fn write_pictures(folder: &Path, scene: &Scene, study: &Study, size: (u32, u32)) -> Result<(), String> {
    let write = |name: &str, picture: &Image| {
        PendingFile::create(&folder.join(name))?.finish(&Format::Png.encode(picture)?)
    };
    let truth = &study.reference.picture;
    write("reference.png", truth)?;
    let own = study.report_row();
    for row in study.rows.iter().filter(|row| row.in_front || row.setting == own.setting) {
        let scene = row.setting.applied_to(scene);
        let (width, height) = size;
        let work = tracer(&scene, width, height, row.setting.arithmetic).map_err(|e| e.to_string())?;
        let picture = render(&*work, size)?;
        let name = row.setting.to_string().replace(", ", "-").replace(' ', "-");
        write(&format!("{name}.png"), &picture)?;
        write(&format!("{name}-difference.png"), &flip::picture(truth, &picture))?;
    }
    Ok(())
}
