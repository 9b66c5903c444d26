//! `rayweave sample`: the process that `compare` starts for each of its samples. It is internal, so
//! `--help` does not list it.

use crate::input::Input;
use crate::options::checked_tile;
use crate::subprocess::{Answer, Job};
use crate::{Outcome, print};
use clap::Args;
use rayweave_contract::Rect;
use rayweave_core::{primary_packets, primary_rays};
use rayweave_measure::InProcessExecutor;
use rayweave_measure::compare::{Entry, Executor};
use std::path::Path;

#[derive(Args)]
pub struct Arguments {
    /// The rendering to do, as JSON
    #[arg(value_parser = parse_job)]
    job: Job,
}

/// Parses a job for clap.
fn parse_job(text: &str) -> Result<Job, String> {
    serde_json::from_str(text).map_err(|e| format!("not a job in JSON: {e}"))
}

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    end_with_parent(arguments.job.parent)?;
    // The parent reads nothing but the answer, so a failure is an answer too.
    let answer = measure(&arguments.job);
    print(&format!("{}\n", serde_json::to_string(&answer).map_err(|e| e.to_string())?))?;
    Ok(Outcome::Passed)
}

fn measure(job: &Job) -> Answer {
    let input = Input::load(job.scene.as_deref().map(Path::new), &job.options)?;
    let (width, height) = (input.width, input.height);
    let tile = checked_tile(job.tile, width, height)?;
    let strategy = rayweave_registry::find(&job.strategy)
        .ok_or_else(|| format!("there is no strategy {}", job.strategy))?;
    let work = input.work(width, height)?;
    let entry = Entry { strategy, threads: job.threads };
    let rays = |tile: Rect| {
        primary_rays(tile.width, tile.height, &input.scene.render, input.execution.share_samples)
    };
    let packets =
        |tile: Rect| primary_packets(tile.width, tile.height, &input.scene.render, input.execution);
    let executor = InProcessExecutor::new(&*work, width, height, tile);
    let mut executor = executor.map_err(|e| e.to_string())?.counting(&rays, &packets);
    if job.count_rays { executor.warm_up(&entry) } else { executor.cold_and_warm(&entry) }
}

/// Makes the end of the parent end this process too, so that it does not disturb a later
/// measurement. Returns an error if the parent has ended already.
fn end_with_parent(parent: u32) -> Result<(), String> {
    #[cfg(target_os = "linux")]
    {
        // If the system refuses, the process ends by itself after rendering.
        let _ = nix::sys::prctl::set_pdeathsig(nix::sys::signal::Signal::SIGKILL);
        if std::os::unix::process::parent_id() != parent {
            return Err("the process that asked for this sample has ended".to_owned());
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = parent;
    Ok(())
}
