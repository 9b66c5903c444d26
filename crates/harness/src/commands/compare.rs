//! `rayweave compare`, and `rayweave` alone: the table.

use crate::input::Input;
use crate::options::{
    SceneOptions, SharingOption, TileOption, all_threads, chosen, distinct, left_out_line, parse_strategy,
    parse_threads,
};
use crate::output::{PendingFile, distinct_files};
use crate::{Outcome, print, progress};
use clap::Args;
use rayweave_core::{Area, Arithmetic, Execution, Strategy, Work, primary_rays};
use rayweave_measure::Protocol;
use rayweave_measure::compare::{Comparison, Entry, Executor};
use rayweave_measure::machine::Machine;
use rayweave_measure::stopwatch::Stopwatch;
use rayweave_report::compare::{BothReport, Report, Subject};
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
    let sharing = options.scene_options.share_samples;
    let ways: &[bool] = match sharing {
        SharingOption::On => &[true],
        SharingOption::Off => &[false],
        SharingOption::Both => &[true, false],
    };
    let input = Input::load_sharing(scene, &options.scene_options, ways[0])?;
    let settings = &input.scene.render;
    if ways.len() > 1 && (!settings.has_lattice() || settings.adaptive) {
        return Err(
            "--share-samples both: without a lattice, or with an adaptive one, there is no choice".to_owned()
        );
    }
    let tile = options.tile.of(input.width, input.height)?;
    let ways: Vec<Execution> =
        ways.iter().map(|&share_samples| Execution { share_samples, ..input.execution }).collect();
    let comparisons = measure(&input, &ways, tile, options)?;
    let subjects: Vec<Subject> = ways.iter().map(|&way| subject(&input, way, tile)).collect();
    let machine = Machine::here();
    let reports: Vec<Report<'_>> = subjects
        .iter()
        .zip(&comparisons)
        .map(|(subject, comparison)| Report { subject, comparison, machine: &machine })
        .collect();
    let [table, json_text, csv_text] = match reports[..] {
        [shared, unshared] => {
            let both = BothReport { shared, unshared };
            [both.table(), both.json(), both.csv()]
        }
        _ => [reports[0].table(), reports[0].json(), reports[0].csv()],
    };
    let skipped = input.skipped_line().map(|line| line + "\n").unwrap_or_default();
    let left_out = left_out_line(&options.strategy);
    print(&format!("{table}\n{}\n{skipped}{left_out}", input.arithmetic_line()))?;
    json.map_or(Ok(()), |file| file.finish(json_text.as_bytes()))?;
    csv.map_or(Ok(()), |file| file.finish(csv_text.as_bytes()))?;
    Ok(if comparisons.iter().all(Comparison::holds) { Outcome::Held } else { Outcome::Failed })
}

fn subject(input: &Input, execution: Execution, tile: NonZeroU32) -> Subject {
    let Execution { arithmetic: Arithmetic { formulas, precision }, lanes, share_samples, search } =
        execution;
    Subject {
        scene: input.name.clone(),
        width: input.width,
        height: input.height,
        tile: tile.get(),
        antialiasing: input.scene.render.antialiasing,
        sampling: input.scene.render.sampling,
        adaptive: input.scene.render.adaptive,
        formulas,
        precision: precision.to_string(),
        lanes: lanes.count(precision),
        share_samples,
        search,
    }
}

/// Steps of the progress bar.
const STEPS: f64 = 1000.0;

/// A comparison for each way to compute the picture, measured in the same rounds.
fn measure(
    input: &Input,
    ways: &[Execution],
    tile: NonZeroU32,
    options: &Options,
) -> Result<Vec<Comparison>, String> {
    let strategies = chosen(&options.strategy);
    let threads =
        if options.threads.is_empty() { vec![all_threads()] } else { distinct(&options.threads, |n| *n) };
    let pairs = strategies.iter().flat_map(|&strategy| threads.iter().map(move |&n| (strategy, n)));
    let entries: Vec<Entry<'_>> = pairs.map(|(strategy, threads)| Entry { strategy, threads }).collect();

    let (width, height) = (input.width, input.height);
    let works = ways.iter().map(|&way| input.work_by(way, width, height));
    let works = works.collect::<Result<Vec<Box<dyn Work + Send>>, _>>()?;
    let rays = |way: &Execution| {
        let share_samples = way.share_samples;
        move |tile: Area| primary_rays(tile.width, tile.height, &input.scene.render, share_samples)
    };
    let rays: Vec<_> = ways.iter().map(rays).collect();
    let stopwatches = works.iter().zip(&rays).map(|(work, rays)| {
        let stopwatch = Stopwatch::new(&**work, width, height, tile).map_err(|e| e.to_string())?;
        Ok(stopwatch.counting(rays))
    });
    let mut stopwatches = stopwatches.collect::<Result<Vec<Stopwatch<'_>>, String>>()?;
    let mut executors: Vec<&mut dyn Executor> =
        stopwatches.iter_mut().map(|stopwatch| stopwatch as &mut dyn Executor).collect();

    let bar = progress::bar(STEPS as u64);
    let protocol = Protocol::default();
    // Each way gets the time that it would have had alone.
    let protocol = Protocol { budget: protocol.budget * ways.len() as u32, ..protocol };
    let comparisons =
        protocol.run_together(rayweave_registry::reference(), &entries, &mut executors, |progress| {
            // Drawn here and nowhere else: between the timed spans.
            bar.set_message(format!("{}, threads: {}", progress.strategy, progress.threads));
            bar.set_position((progress.fraction * STEPS) as u64);
        });
    bar.finish_and_clear();
    comparisons.map_err(|e| e.to_string())
}
