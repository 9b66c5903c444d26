//! Builds the rayon pool of a strategy. All strategies on rayon share it.

use rayon::{ThreadPool, ThreadPoolBuilder};
use rayweave_contract::StrategyError;
use std::io;
use std::num::NonZeroUsize;

/// Builds a pool of exactly `threads` threads, named after the strategy.
///
/// # Errors
///
/// A thread could not be started.
pub fn build(strategy: &'static str, threads: NonZeroUsize) -> Result<ThreadPool, StrategyError> {
    let threads = threads.get();
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(move |index| format!("{strategy} {index}"))
        .build()
        .map_err(|e| StrategyError::Spawn { strategy, threads, source: io::Error::other(e) })
}
