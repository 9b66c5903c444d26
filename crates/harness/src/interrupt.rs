//! Ctrl-C, for commands that can show a partial result.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that an interruption sets, once it is [watched](Interrupt::watch).
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Makes the first interruption set the flag, and the second end the program. On a system
    /// without signals the first one ends the program.
    pub fn watch() -> Self {
        let happened = Arc::new(AtomicBool::new(false));
        #[cfg(unix)]
        {
            use signal_hook::{consts::SIGINT, flag};
            // In this order the flag is already set at the second signal. If the system refuses,
            // the first signal ends the program.
            let _ = flag::register_conditional_default(SIGINT, Arc::clone(&happened))
                .and_then(|_| flag::register(SIGINT, Arc::clone(&happened)));
        }
        Self(happened)
    }

    /// Returns whether an interruption happened.
    pub fn happened(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
