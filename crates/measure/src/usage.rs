//! What processes have used, as the system counts it.

use std::time::Duration;

/// What a process, all of its threads together, has used since it began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Time on a processor, the system's work for it included.
    pub cpu: Duration,
    /// How often a thread was taken off its processor while it had something to do: somebody else's
    /// turn.
    pub involuntary_switches: u64,
}

impl Usage {
    /// Of this process; `None` where the system does not tell.
    #[must_use]
    pub fn of_this_process() -> Option<Self> {
        system::of_this_process()
    }

    /// Of this process's children that have ended; `None` where the system does not tell.
    #[must_use]
    pub fn of_ended_children() -> Option<Self> {
        system::of_ended_children()
    }

    /// What came since `earlier`.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self {
            cpu: self.cpu.saturating_sub(earlier.cpu),
            involuntary_switches: self
                .involuntary_switches
                .saturating_sub(earlier.involuntary_switches),
        }
    }

    /// Both together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            cpu: self.cpu + other.cpu,
            involuntary_switches: self.involuntary_switches + other.involuntary_switches,
        }
    }
}

#[cfg(unix)]
mod system {
    use super::Usage;
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeVal;
    use std::time::Duration;

    pub(super) fn of_this_process() -> Option<Usage> {
        usage(UsageWho::RUSAGE_SELF)
    }

    pub(super) fn of_ended_children() -> Option<Usage> {
        usage(UsageWho::RUSAGE_CHILDREN)
    }

    fn usage(who: UsageWho) -> Option<Usage> {
        let usage = getrusage(who).ok()?;
        Some(Usage {
            cpu: duration(usage.user_time()) + duration(usage.system_time()),
            involuntary_switches: u64::try_from(usage.involuntary_context_switches()).unwrap_or(0),
        })
    }

    /// Never negative.
    fn duration(time: TimeVal) -> Duration {
        let whole = Duration::from_secs(u64::try_from(time.tv_sec()).unwrap_or(0));
        whole + Duration::from_micros(u64::try_from(time.tv_usec()).unwrap_or(0))
    }
}

#[cfg(not(unix))]
mod system {
    use super::Usage;

    pub(super) fn of_this_process() -> Option<Usage> {
        None
    }

    pub(super) fn of_ended_children() -> Option<Usage> {
        None
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::thread;

    /// Catches the time of the calling thread alone, and that of threads that have ended left out.
    #[test]
    fn the_time_of_every_thread_counts() {
        const BUSY: Duration = Duration::from_millis(20);
        let now = || Usage::of_this_process().expect("a Unix");
        let before = now();
        let busy = move || while now().since(before).cpu < BUSY {};
        thread::spawn(busy).join().expect("no panic");
        let used = now().since(before);
        assert!(used.cpu >= BUSY, "{used:?}");
        assert_eq!(used.plus(used).cpu, 2 * used.cpu);
    }
}
