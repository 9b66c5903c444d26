//! `rayweave overhead`: measures the costs of strategies beyond their work.

use crate::deliver;
use crate::files::PendingFile;
use crate::options::{all_threads, chosen, parse_seconds, parse_threads, strategy_parser};
use crate::with_noise::with_noise;
use crate::{Outcome, print};
use clap::Args;
use rayweave_contract::Strategy;
use rayweave_measure::Protocol;
use rayweave_measure::overhead::Overhead;
use rayweave_output::overhead::OverheadView;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Strategies to measure [default: all]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = strategy_parser())]
    strategy: Vec<Strategy<'static>>,
    /// Number of computing threads [default: all that the machine and its quota allow]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<NonZeroUsize>,
    /// Start no round that would end later than this, after at least 6 rounds [default: 20 rounds
    /// or 20 seconds, whichever comes first]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time_limit: Option<Duration>,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The protocol: six rounds for a 95 % interval, and up to 20 that fit into 20 seconds.
const PROTOCOL: Protocol = Protocol {
    min_rounds: 6,
    max_rounds: 20,
    budget: Duration::from_secs(20),
    goal: None,
    seed: 1,
};

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    let json = arguments.json.as_deref().map(PendingFile::create).transpose()?;
    let strategies = chosen(&arguments.strategy);
    let overhead = Overhead {
        reference: rayweave_registry::reference(),
        strategies: &strategies,
        threads: arguments.threads.unwrap_or_else(all_threads),
        protocol: PROTOCOL.within(arguments.time_limit),
    };
    let (study, machine, noise) = with_noise(|bar| {
        overhead.run(|strategy, fraction| bar.show(fraction, strategy.to_owned()))
    });
    let study = study.map_err(|e| e.to_string())?;
    let view = OverheadView { study: &study, machine: &machine, noise: &noise };
    deliver::all([
        deliver::write(json, || Ok(view.json())),
        print(&format!("{}\n", view.table())),
    ])?;
    Ok(if study.passed() { Outcome::Passed } else { Outcome::Failed })
}
