//! `rayweave strategies`: lists the strategies.

use crate::{Outcome, print};
use rayweave_contract::{Plan, Threads};
use rayweave_registry::STRATEGIES;
use std::num::{NonZeroU32, NonZeroUsize};

pub fn run() -> Result<Outcome, String> {
    let width = STRATEGIES.iter().map(|strategy| strategy.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for strategy in STRATEGIES {
        let threads = match strategy.threads {
            Threads::None => "no threads of its own",
            Threads::Pool => "threads started once, before rendering",
            Threads::PerRender => "threads started within each rendering",
        };
        text +=
            &format!("{:width$}  {}\n{:width$}  {threads}\n", strategy.name, strategy.summary, "");
        // Preparing a strategy shows whether it is available, and the reason if not.
        let plan = Plan { threads: NonZeroUsize::MIN, tile: NonZeroU32::MIN };
        let failure = || strategy.prepare(plan).err().map(|error| error.to_string());
        if let Some(reason) = strategy.unavailable.map(str::to_owned).or_else(failure) {
            text += &format!("{:width$}  unavailable here: {reason}\n", "");
        }
    }
    print(&text)?;
    Ok(Outcome::Passed)
}
