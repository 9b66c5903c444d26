//! `rayweave explain`: shows where the time of each thread goes.

use crate::deliver;
use crate::files::{PendingFile, distinct_files};
use crate::image_file::ImageFormat;
use crate::input::Input;
use crate::options::{
    TileOption, WorkOptions, all_threads, distinct, parse_seconds, parse_threads, strategy_parser,
};
use crate::with_noise::with_noise;
use crate::{Outcome, print};
use clap::Args;
use rayweave_contract::{Rect, Strategy};
use rayweave_core::primary_rays;
use rayweave_measure::Protocol;
use rayweave_measure::explanation::{ExplainError, ExplainExperiment};
use rayweave_output::explain::ExplanationView;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the lab report's scene, which is built in]
    scene: Option<PathBuf>,
    /// Strategies to explain [default: the recommended one]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = strategy_parser())]
    strategy: Vec<Strategy<'static>>,
    /// Number of computing threads [default: all that the machine and its quota allow]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<NonZeroUsize>,
    #[command(flatten)]
    tile: TileOption,
    /// Start no round that would end later than this, after at least 6 rounds; for all strategies
    /// together [default: 200 rounds or 20 seconds a strategy, whichever comes first]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time_limit: Option<Duration>,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the time lines as trace events, for Perfetto (ui.perfetto.dev) or chrome://tracing
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Write three images of each strategy into this folder: the time line, the thread of each
    /// pixel, and the time of each pixel
    #[arg(long, value_name = "FOLDER")]
    pictures: Option<PathBuf>,
    #[command(flatten)]
    work: WorkOptions,
}

/// The protocol for one strategy. A round has three renderings of it, one on a single thread.
const PROTOCOL: Protocol = Protocol {
    min_rounds: 6,
    max_rounds: 200,
    budget: Duration::from_secs(20),
    goal: None,
    seed: 1,
};

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    distinct_files(&[&arguments.scene, &arguments.json, &arguments.trace])?;
    let [json, trace] = [&arguments.json, &arguments.trace]
        .map(|path| path.as_deref().map(PendingFile::create).transpose());
    let (json, trace) = (json?, trace?);
    let scene = arguments.scene.as_deref();
    let input = Input::load(scene, &arguments.work.of_scene(scene))?;
    let (width, height) = input.recordable_size()?;
    let recommended = [rayweave_registry::recommended()];
    let strategies = distinct(
        if arguments.strategy.is_empty() { &recommended } else { &arguments.strategy },
        |s| s.name,
    );
    let pictures =
        arguments.pictures.as_deref().map(|folder| image_files(folder, &strategies)).transpose()?;
    let tile = arguments.tile.of(width, height)?;
    let work = input.work(width, height)?;
    let protocol = Protocol { budget: PROTOCOL.budget * strategies.len() as u32, ..PROTOCOL };
    let experiment = ExplainExperiment {
        work: &*work,
        size: (width, height),
        tile,
        reference: rayweave_registry::reference(),
        protocol: protocol.within(arguments.time_limit),
    };
    let threads = arguments.threads.unwrap_or_else(all_threads);
    // The bar is drawn between the timed spans.
    let (explained, machine, noise) =
        with_noise(|bar| experiment.run(&strategies, threads, |fraction| bar.show(fraction, "")));
    let explanation = match explained {
        Ok(explanation) => explanation,
        Err(error @ ExplainError::Different { .. }) => {
            print(&format!("{}\n{error}\n", input.describe()))?;
            return Ok(Outcome::Failed);
        }
        Err(error) => return Err(error.to_string()),
    };

    let rays = |tile: Rect| {
        primary_rays(tile.width, tile.height, &input.scene.render, input.execution.share_samples)
    };
    let view = ExplanationView {
        scene: &input.name,
        size: (width, height),
        tile: tile.get(),
        explanation: &explanation,
        rays: &rays,
        machine: &machine,
        noise: &noise,
    };
    deliver::all([
        deliver::write(json, || Ok(view.json())),
        deliver::write(trace, || Ok(view.trace())),
        pictures.map_or(Ok(()), |files| write_images(files, &view)),
        print(&format!("{}\n\n{}\n", input.describe(), view.text())),
    ])?;
    Ok(Outcome::Passed)
}

/// The images of one strategy.
struct ImageFiles {
    timeline: PendingFile,
    owners: PendingFile,
    cost: PendingFile,
}

/// Creates the folder and checks that all images can be written, before anything is measured.
fn image_files(folder: &Path, strategies: &[Strategy<'_>]) -> Result<Vec<ImageFiles>, String> {
    fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    let of = |strategy: &Strategy<'_>| {
        let file = |what| PendingFile::create(&folder.join(format!("{}-{what}", strategy.name)));
        Ok(ImageFiles {
            timeline: file("timeline.svg")?,
            owners: file("threads.png")?,
            cost: file("cost.svg")?,
        })
    };
    strategies.iter().map(of).collect()
}

fn write_images(files: Vec<ImageFiles>, view: &ExplanationView<'_>) -> Result<(), String> {
    deliver::all(files.into_iter().zip(&view.explanation.rows).flat_map(|(files, row)| {
        let owners = || ImageFormat::Png.encode(&view.owners(row).map_err(|e| e.to_string())?);
        [
            deliver::write(Some(files.timeline), || view.timeline(row)),
            deliver::write(Some(files.owners), owners),
            deliver::write(Some(files.cost), || view.cost(row)),
        ]
    }))
}
