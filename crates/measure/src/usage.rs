//! The CPU time and the context switches of processes, as the operating system counts them.

use std::time::Duration;

/// The resources that a process has used since it began, all of its threads together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// The CPU time in user and system mode.
    pub cpu: Duration,
    /// The number of times that a thread lost its core although it could have continued.
    pub involuntary_switches: u64,
}

impl Usage {
    /// Returns the usage of this process; `None` if the system does not provide it.
    #[must_use]
    pub fn of_this_process() -> Option<Self> {
        system::of_this_process()
    }

    /// Returns the usage of the children that have ended; `None` if the system does not provide it.
    #[must_use]
    pub fn of_ended_children() -> Option<Self> {
        system::of_ended_children()
    }

    /// Returns the usage since `earlier`.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self {
            cpu: self.cpu.saturating_sub(earlier.cpu),
            involuntary_switches: self
                .involuntary_switches
                .saturating_sub(earlier.involuntary_switches),
        }
    }

    /// Returns the sum of both usages.
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

    /// Returns `time`, which is never negative, as a duration.
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

    /// Catches a usage of the calling thread alone, or without threads that have ended.
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
