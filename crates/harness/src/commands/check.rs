//! `rayweave check`: proves that all strategies render the same image.

use crate::deliver;
use crate::files::{PendingFile, distinct_files};
use crate::input::Input;
use crate::options::{
    SceneOptions, all_threads, checked_tile, chosen, distinct, left_out_line, parse_threads,
    strategy_parser,
};
use crate::{Outcome, print, progress};
use clap::Args;
use rayweave_contract::Strategy;
use rayweave_measure::check::{Check, CheckCase, CheckProgress, Verdict};
use rayweave_measure::computing_threads::TIMEOUT;
use rayweave_measure::machine::Machine;
use rayweave_output as output;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the lab report's scene, which is built in]
    scene: Option<PathBuf>,
    /// Strategies to check [default: all]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = strategy_parser())]
    strategy: Vec<Strategy<'static>>,
    /// Numbers of computing threads [default: all cores for the full size; for several small sizes
    /// 1, 2, 3, all and twice all]
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = parse_threads)]
    threads: Vec<NonZeroUsize>,
    /// Sides of a tile in pixels [default: 32 for the full size; 1, 7 and 32 for small sizes]
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    tile: Vec<NonZeroU32>,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    options: SceneOptions,
}

/// Image sizes with uneven rows, columns or tiles, or with fewer pixels than threads.
const AWKWARD_SIZES: [(u32, u32); 5] = [(1, 1), (1, 50), (50, 1), (7, 3), (97, 61)];

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    distinct_files(&[&arguments.scene, &arguments.json])?;
    let json = arguments.json.as_deref().map(PendingFile::create).transpose()?;
    let input = Input::load(arguments.scene.as_deref(), &arguments.options)?;
    // Fail before any check if the full image cannot exist.
    input.image()?;
    arguments
        .tile
        .iter()
        .try_for_each(|&tile| checked_tile(tile, input.width, input.height).map(drop))?;
    let strategies = chosen(&arguments.strategy);

    let mut verdict = Verdict { checked: Vec::new(), compared: 0, findings: Vec::new() };
    let mut check = |sizes: &[(u32, u32)],
                     threads: &[usize],
                     tiles: &[u32],
                     timeout: Option<Duration>|
     -> Result<(), String> {
        let cases = sizes.iter().map(|&size| case(&input, size)).collect::<Result<Vec<_>, _>>()?;
        let threads =
            or_default(&arguments.threads, threads.iter().copied().filter_map(NonZeroUsize::new));
        let tiles = or_default(&arguments.tile, tiles.iter().copied().filter_map(NonZeroU32::new));
        let part = run_with_bar(&Check {
            reference: rayweave_registry::reference(),
            strategies: &strategies,
            cases: &cases,
            threads: &threads,
            tiles: &tiles,
            timeout,
        })?;
        verdict.checked.extend(part.checked);
        verdict.compared += part.compared;
        verdict.findings.extend(part.findings);
        Ok(())
    };
    let all = all_threads().get();
    let mut counts = vec![1, 2, 3, all, 2 * all];
    counts.sort_unstable();
    counts.dedup();
    check(&AWKWARD_SIZES, &counts, &[1, 7, 32], Some(TIMEOUT))?;
    // The threads are counted: their rendezvous has an image of its own, whatever the size here.
    check(&[(input.width, input.height)], &[all], &[32], None)?;

    let machine = Machine::here();
    let facts = output::machine::text(&machine);
    let left_out = left_out_line(&arguments.strategy).map(|line| line + "\n").unwrap_or_default();
    let text = output::check::text(&verdict);
    deliver::all([
        deliver::write(json, || Ok(output::check::json(&verdict, &machine))),
        print(&format!("{}\n{facts}\n\n{}\n{left_out}", input.describe(), text.trim_end())),
    ])?;
    Ok(if verdict.passed() { Outcome::Passed } else { Outcome::Failed })
}

fn run_with_bar(check: &Check<'_>) -> Result<Verdict, String> {
    let bar = progress::bar(0);
    // The clock runs while threads are waited for.
    progress::draw_steadily(&bar);
    let verdict = check.run(|progress| {
        bar.set_length(progress.total as u64);
        bar.set_position(progress.done as u64);
        let CheckProgress { strategy, threads, is_counting, .. } = progress;
        let waits = if is_counting { ", waiting until all compute at the same time" } else { "" };
        bar.set_message(format!("{strategy}, threads: {threads}{waits}"));
    });
    bar.finish_and_clear();
    verdict.map_err(|e| e.to_string())
}

fn case(input: &Input, (width, height): (u32, u32)) -> Result<CheckCase<'static>, String> {
    Ok(CheckCase { name: input.name.clone(), width, height, work: input.work(width, height)? })
}

fn or_default<T: Copy + PartialEq>(given: &[T], default: impl Iterator<Item = T>) -> Vec<T> {
    if given.is_empty() { default.collect() } else { distinct(given, |value| *value) }
}
