//! Signals that end a run, for commands that can show a partial result.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that an interruption sets, once it is [watched](Interrupt::watch).
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Makes the first SIGINT (Ctrl-C), SIGTERM or SIGHUP set the flag, and the second end the
    /// program. A signal that the caller had ignored (`nohup`, `trap '' INT`) stays ignored. On a
    /// system without signals the first one ends the program.
    pub fn watch() -> Self {
        let happened = Arc::new(AtomicBool::new(false));
        #[cfg(unix)]
        {
            use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
            use signal_hook::flag;
            for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| !ignored(signal)) {
                // In this order the flag is already set at the second signal. If the system
                // refuses, the first signal ends the program.
                let _ = flag::register_conditional_default(signal, Arc::clone(&happened))
                    .and_then(|_| flag::register(signal, Arc::clone(&happened)));
            }
        }
        Self(happened)
    }

    /// Returns a flag that nothing sets.
    #[cfg(test)]
    pub fn never() -> Self {
        Self(Arc::default())
    }

    /// Returns whether an interruption happened.
    pub fn happened(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Returns whether this process was started with the signal ignored, where the system tells (on
/// Linux, in `/proc`).
#[cfg(unix)]
fn ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
