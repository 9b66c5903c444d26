//! `rayweave compare`, and `rayweave` alone: the table.

use crate::input::Input;
use crate::options::{SceneOptions, TileOption, all_threads, distinct, parse_strategy, parse_threads};
use crate::output::{PendingFile, distinct_files};
use crate::{Outcome, print, progress};
use clap::Args;
use rayweave_core::Strategy;
use rayweave_measure::Protocol;
use rayweave_measure::compare::{Comparison, Entry};
use rayweave_measure::machine::Machine;
use rayweave_measure::stopwatch::Stopwatch;
use rayweave_registry::STRATEGIES;
use rayweave_report::compare::{Report, Subject};
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the report's scene, built in]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub options: Options,
}

#[derive(Args)]
pub struct Options {
    /// Strategies to time [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = parse_strategy)]
    strategy: Vec<&'static dyn Strategy>,
    /// Numbers of computing threads [default: what the machine and its quota allow]
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = parse_threads)]
    threads: Vec<NonZeroUsize>,
    #[command(flatten)]
    tile: TileOption,
    /// Write the result as JSON, raw samples included
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the table as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub fn run(scene: Option<&Path>, options: &Options) -> Result<Outcome, String> {
    distinct_files(&[&scene.map(Path::to_owned), &options.json, &options.csv])?;
    let json = options.json.as_deref().map(PendingFile::create).transpose()?;
    let csv = options.csv.as_deref().map(PendingFile::create).transpose()?;
    let input = Input::load(scene, &options.scene_options)?;
    let tile = options.tile.of(input.width, input.height)?;
    let comparison = measure(&input, tile, options)?;
    let subject = Subject {
        scene: input.name.clone(),
        width: input.width,
        height: input.height,
        tile: tile.get(),
        antialiasing: input.scene.render.antialiasing,
        sampling: input.scene.render.sampling,
        formulas: input.execution.arithmetic.formulas,
        precision: input.execution.arithmetic.precision.to_string(),
    };
    let report = Report { subject: &subject, comparison: &comparison, machine: &Machine::here() };
    print(&format!("{}\n{}\n", report.table(), input.arithmetic_line()))?;
    json.map_or(Ok(()), |file| file.finish(report.json().as_bytes()))?;
    csv.map_or(Ok(()), |file| file.finish(report.csv().as_bytes()))?;
    Ok(if comparison.holds() { Outcome::Held } else { Outcome::Failed })
}

/// Steps of the progress bar.
const STEPS: f64 = 1000.0;

fn measure(input: &Input, tile: NonZeroU32, options: &Options) -> Result<Comparison, String> {
    let work = input.work(input.width, input.height)?;
    let mut stopwatch = Stopwatch::new(&*work, input.width, input.height, tile).map_err(|e| e.to_string())?;
    let strategies =
        distinct(if options.strategy.is_empty() { STRATEGIES } else { &options.strategy }, |s| s.name());
    let threads =
        if options.threads.is_empty() { vec![all_threads()] } else { distinct(&options.threads, |n| *n) };
    let pairs = strategies.iter().flat_map(|&strategy| threads.iter().map(move |&n| (strategy, n)));
    let entries: Vec<Entry<'_>> = pairs.map(|(strategy, threads)| Entry { strategy, threads }).collect();

    let bar = progress::bar(STEPS as u64);
    let comparison =
        Protocol::default().run(rayweave_registry::reference(), &entries, &mut stopwatch, |progress| {
            // Drawn here and nowhere else: between the timed spans.
            bar.set_message(format!("{}, threads: {}", progress.strategy, progress.threads));
            bar.set_position((progress.fraction * STEPS) as u64);
        });
    bar.finish_and_clear();
    comparison.map_err(|e| e.to_string())
}
