//! `rayweave predict`: predicts speed-ups on more threads.

use crate::deliver;
use crate::files::{PendingFile, distinct_files};
use crate::input::Input;
use crate::options::{
    TileOption, WorkOptions, all_threads, chosen, parse_seconds, parse_thread_counts,
    strategy_parser,
};
use crate::with_noise::with_noise;
use crate::{Outcome, print};
use clap::Args;
use rayweave_contract::Strategy;
use rayweave_measure::Protocol;
use rayweave_measure::forecast::{Question, Stage};
use rayweave_output::forecast::ForecastView;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the lab report's scene, which is built in]
    scene: Option<PathBuf>,
    /// Strategies to predict; each must start threads [default: all that do]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = strategy_parser())]
    strategy: Vec<Strategy<'static>>,
    /// Numbers of computing threads, each 1..=1024. A..B is A, B and the powers of two between
    #[arg(
        long,
        value_name = "N,A..B",
        value_delimiter = ',',
        value_parser = parse_thread_counts,
        default_value = "1..64"
    )]
    threads: Vec<Counts>,
    #[command(flatten)]
    tile: TileOption,
    /// Start no round that would end later than this, after at least 8 rounds. Measuring the
    /// overheads of threads is extra [default: 40 rounds or 60 seconds, whichever comes first]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time_limit: Option<Duration>,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a plot as SVG
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    work: WorkOptions,
}

/// The numbers of threads of one value in the list.
type Counts = Vec<NonZeroUsize>;

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    distinct_files(&[&arguments.scene, &arguments.json, &arguments.svg])?;
    let json = arguments.json.as_deref().map(PendingFile::create).transpose()?;
    let svg = arguments.svg.as_deref().map(PendingFile::create).transpose()?;
    let scene = arguments.scene.as_deref();
    let input = Input::load(scene, &arguments.work.of_scene(scene))?;
    let (width, height) = input.recordable_size()?;
    let tile = arguments.tile.of(width, height)?;
    let strategies = chosen(&arguments.strategy);
    let mut threads = arguments.threads.concat();
    threads.sort_unstable();
    threads.dedup();
    let work = input.work(width, height)?;
    let question = Question {
        work: &*work,
        size: (width, height),
        tile,
        reference: rayweave_registry::reference(),
        strategies: &strategies,
        threads: &threads,
        available: all_threads(),
        protocol: Protocol::default().within(arguments.time_limit),
    };
    let message = |stage| match stage {
        Stage::Overheads => "overheads of threads",
        Stage::Renderings => "renderings",
    };
    let (forecast, machine, noise) =
        with_noise(|bar| question.answer(|stage, fraction| bar.show(fraction, message(stage))));
    let forecast = forecast.map_err(|e| format!("{}: {e}", input.name))?;
    let view = ForecastView {
        scene: &input.name,
        width,
        height,
        tile: tile.get(),
        forecast: &forecast,
        machine: &machine,
        noise: &noise,
    };
    deliver::all([
        deliver::write(json, || Ok(view.json())),
        deliver::write(svg, || view.svg()),
        print(&format!("{}\n{}\n", view.table(), input.arithmetic_line())),
    ])?;
    Ok(if forecast.comparison.passed() { Outcome::Passed } else { Outcome::Failed })
}
