//! Builds the rayon pool of a strategy. All strategies on rayon share it.
//!
//! The pool is the strategy's own, with exactly the requested threads: rayon's global pool has as
//! many as the machine has cores, whatever a caller wants to measure.

use rayon::{ThreadPool, ThreadPoolBuilder};
use rayweave_contract::RenderError;
use std::io;
use std::num::NonZeroUsize;

/// Builds a pool of exactly `threads` threads.
///
/// # Errors
///
/// A thread could not be started.
pub fn build(threads: NonZeroUsize) -> Result<ThreadPool, RenderError> {
    let threads = threads.get();
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|index| format!("thread {index}"))
        .build()
        .map_err(|e| RenderError::Spawn { threads, source: io::Error::other(e) })
}
