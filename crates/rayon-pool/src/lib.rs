//! Builds a rayon pool of a strategy's own: what every strategy on rayon needs, and no strategy
//! should have to say twice.

use rayon::{ThreadPool, ThreadPoolBuilder};
use rayweave_contract::StrategyError;
use std::io;
use std::num::NonZeroUsize;

/// A pool with exactly `threads` computing threads, named after the strategy.
///
/// # Errors
///
/// A thread that could not be started.
pub fn build(strategy: &'static str, threads: NonZeroUsize) -> Result<ThreadPool, StrategyError> {
    let threads = threads.get();
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(move |index| format!("{strategy} {index}"))
        .build()
        .map_err(|e| StrategyError::Spawn { strategy, threads, source: io::Error::other(e) })
}
