//! `rayweave sample`: what `compare` starts for each of its samples. Not for people, so `--help`
//! does not list it.

use crate::child::{Answer, Rendered};
use crate::input::Input;
use crate::options::{SceneOptions, TileOption, parse_threads, strategy_parser};
use crate::{Outcome, print};
use clap::Args;
use rayweave_contract::{Rect, Strategy};
use rayweave_core::primary_rays;
use rayweave_measure::Stopwatch;
use rayweave_measure::compare::{Entry, Executor};
use std::num::NonZeroUsize;
use std::path::PathBuf;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the report's scene, built in]
    scene: Option<PathBuf>,
    /// Strategy to render with
    #[arg(long, value_name = "NAME", value_parser = strategy_parser())]
    strategy: &'static dyn Strategy,
    /// Number of computing threads
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: NonZeroUsize,
    #[command(flatten)]
    tile: TileOption,
    /// Render once and count the rays, instead of twice with all times
    #[arg(long)]
    count_rays: bool,
    #[command(flatten)]
    options: SceneOptions,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    end_with_parent();
    // Whoever started this reads the answer and nothing else: a failure is one, too.
    let answer = measure(arguments).map_or_else(Answer::Failed, Answer::Rendered);
    print(&format!("{}\n", serde_json::to_string(&answer).map_err(|e| e.to_string())?))?;
    Ok(Outcome::Held)
}

fn measure(arguments: &Arguments) -> Result<Rendered, String> {
    let input = Input::load(arguments.scene.as_deref(), &arguments.options)?;
    let (width, height) = (input.width, input.height);
    let tile = arguments.tile.of(width, height)?;
    let work = input.work(width, height)?;
    let entry = Entry { strategy: arguments.strategy, threads: arguments.threads };
    let rays = |tile: Rect| {
        primary_rays(tile.width, tile.height, &input.scene.render, input.execution.share_samples)
    };
    let stopwatch = Stopwatch::new(&*work, width, height, tile).map_err(|e| e.to_string())?;
    let mut stopwatch = stopwatch.counting(&rays);
    if arguments.count_rays {
        return stopwatch.warm_up(&entry).map(Rendered::from);
    }
    Ok(Rendered::from((stopwatch.one_shot_and_again(&entry)?, None)))
}

/// Whatever ends the parent, this process does not go on computing beside what somebody measures
/// next.
fn end_with_parent() {
    #[cfg(target_os = "linux")]
    // Where it is refused, the process ends by itself when it has rendered.
    let _ = nix::sys::prctl::set_pdeathsig(nix::sys::signal::Signal::SIGKILL);
}
