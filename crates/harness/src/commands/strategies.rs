//! `rayweave strategies`: what there is.

use crate::{Outcome, print};
use rayweave_contract::{Plan, ThreadsStart};
use rayweave_registry::STRATEGIES;
use std::num::{NonZeroU32, NonZeroUsize};

pub fn run() -> Result<Outcome, String> {
    let width = STRATEGIES.iter().map(|strategy| strategy.name().len()).max().unwrap_or(0);
    let mut text = String::new();
    for strategy in STRATEGIES {
        let threads = match strategy.threads_start() {
            ThreadsStart::Never => "no threads of its own",
            ThreadsStart::Prepare => "threads started once, before rendering",
            ThreadsStart::Render => "threads started within each rendering",
        };
        text += &format!(
            "{:width$}  {}\n{:width$}  {threads}\n",
            strategy.name(),
            strategy.summary(),
            ""
        );
        // Tried out, not guessed: what cannot be prepared here says why.
        let plan = Plan { threads: NonZeroUsize::MIN, tile: NonZeroU32::MIN };
        let failure = || strategy.prepare(plan).err().map(|error| error.to_string());
        if let Some(reason) = strategy.unavailable().map(str::to_owned).or_else(failure) {
            text += &format!("{:width$}  unavailable here: {reason}\n", "");
        }
    }
    print(&text)?;
    Ok(Outcome::Held)
}
