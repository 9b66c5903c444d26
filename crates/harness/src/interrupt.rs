//! Ctrl-C, for a command that has something to show by then.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the program was interrupted since somebody [watches](Interrupt::watch).
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// From now on the first interruption is noticed, and only the second ends the program at once.
    /// Where the system has no signals the first one does.
    pub fn watch() -> Self {
        let happened = Arc::new(AtomicBool::new(false));
        #[cfg(unix)]
        {
            use signal_hook::{consts::SIGINT, flag};
            // In this order: at the second signal, the flag is set already. Where the system
            // refuses, the first signal ends the program, as it did before.
            let _ = flag::register_conditional_default(SIGINT, Arc::clone(&happened))
                .and_then(|_| flag::register(SIGINT, Arc::clone(&happened)));
        }
        Self(happened)
    }

    /// Whether it was.
    pub fn happened(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
