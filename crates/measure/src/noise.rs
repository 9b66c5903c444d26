//! What else went on while something was measured: other programs, the hypervisor, limits, the
//! clock rate.
//!
//! All of it is what Linux shows under `/proc` and `/sys`; what is not there is unknown.

use crate::machine::cpu_groups;
use crate::usage::Usage;
use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;
use std::time::{Duration, Instant};

/// The length of a tick in `/proc/stat`, in milliseconds: a hundred a second, whatever the kernel's
/// own.
const TICK_MS: u64 = 10;

/// The share of the machine that others may use before a measurement counts as disturbed.
const QUIET: f64 = 0.02;

/// What went on during a measurement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Noise {
    /// How long it took.
    pub wall: Duration,
    /// Logical cores of the machine.
    pub cores: usize,
    /// CPU time of all other programs on the machine, those in other containers included.
    pub foreign: Option<Duration>,
    /// Time that a hypervisor gave to other machines while this one had something to do.
    pub stolen: Option<Duration>,
    /// How often the control group's limit stopped this process and its neighbours in the group.
    pub throttled: Option<u64>,
    /// How often a thread of ours had to make room for somebody else.
    pub involuntary_switches: Option<u64>,
    /// The lowest and the highest clock rate of a core at the beginning and the end, in MHz.
    pub megahertz: Option<RangeInclusive<f64>>,
}

impl Noise {
    /// Whether the times are to be doubted: others had more than 2 % of the machine, or the limit
    /// was reached.
    #[must_use]
    pub fn is_disturbing(&self) -> bool {
        self.share_of_others().is_some_and(|share| share > QUIET)
            || self.throttled.is_some_and(|times| times > 0)
    }

    /// What share of the machine other programs and other machines had: 0 to 1.
    #[must_use]
    pub fn share_of_others(&self) -> Option<f64> {
        let others = self.foreign? + self.stolen.unwrap_or_default();
        let all = self.wall.as_secs_f64() * self.cores.max(1) as f64;
        Some((others.as_secs_f64() / all.max(f64::MIN_POSITIVE)).min(1.0))
    }
}

/// Looks at the machine from its making until it is [finished](Watch::finish).
#[derive(Debug)]
pub struct Watch {
    begin: Instant,
    before: Look,
}

impl Watch {
    /// Begins to watch.
    #[must_use]
    pub fn start() -> Self {
        Self { begin: Instant::now(), before: Look::now() }
    }

    /// What went on since then, on a machine of `cores` logical cores.
    #[must_use]
    pub fn finish(self, cores: usize) -> Noise {
        let (wall, after) = (self.begin.elapsed(), Look::now());
        let Self { before, .. } = self;
        let own = after.own.zip(before.own).map(|(after, before)| after.since(before));
        let times = after.times.zip(before.times);
        let busy = times.map(|(after, before)| after.busy.saturating_sub(before.busy));
        Noise {
            wall,
            cores,
            foreign: busy.zip(own).map(|(busy, own)| busy.saturating_sub(own.cpu)),
            stolen: times.map(|(after, before)| after.stolen.saturating_sub(before.stolen)),
            throttled: after
                .throttled
                .zip(before.throttled)
                .map(|(after, before)| after.saturating_sub(before)),
            involuntary_switches: own.map(|own| own.involuntary_switches),
            megahertz: range(before.megahertz.into_iter().chain(after.megahertz)),
        }
    }
}

/// What there is to see at one moment, all of it since some beginning.
#[derive(Debug)]
struct Look {
    times: Option<Times>,
    own: Option<Usage>,
    throttled: Option<u64>,
    megahertz: Vec<f64>,
}

impl Look {
    fn now() -> Self {
        let stat = fs::read_to_string("/proc/stat").unwrap_or_default();
        let own = Usage::of_this_process().zip(Usage::of_ended_children());
        Self {
            times: Times::of(&stat),
            own: own.map(|(this, children)| this.plus(children)),
            throttled: throttled(),
            megahertz: megahertz(),
        }
    }
}

/// What all processors together have done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Times {
    busy: Duration,
    stolen: Duration,
}

impl Times {
    /// From the line "cpu user nice system idle iowait irq softirq steal ..." of `/proc/stat`, in
    /// ticks.
    fn of(stat: &str) -> Option<Self> {
        let line = stat.lines().find_map(|line| line.strip_prefix("cpu "))?;
        let ticks = line.split_whitespace().map(|number| number.parse().ok());
        let ticks: Vec<u64> = ticks.collect::<Option<_>>()?;
        let [user, nice, system, _, _, irq, softirq, steal, ..] = ticks[..] else { return None };
        let time = |ticks: u64| Duration::from_millis(ticks.saturating_mul(TICK_MS));
        let busy = [user, nice, system, irq, softirq].map(time).iter().sum();
        Some(Self { busy, stolen: time(steal) })
    }
}

/// How often the groups that this process is in have been stopped, all of them together.
fn throttled() -> Option<u64> {
    let stats = cpu_groups()
        .into_iter()
        .filter_map(|(_, folder)| fs::read_to_string(folder.join("cpu.stat")).ok());
    stats.filter_map(|stat| times_throttled(&stat)).reduce(|a, b| a + b)
}

fn times_throttled(stat: &str) -> Option<u64> {
    stat.lines().find_map(|line| line.strip_prefix("nr_throttled "))?.trim().parse().ok()
}

/// The clock rate of each core now.
fn megahertz() -> Vec<f64> {
    let Ok(cores) = fs::read_dir("/sys/devices/system/cpu") else { return Vec::new() };
    cores
        .filter_map(|core| kilohertz(&core.ok()?.path()))
        .map(|kilohertz| kilohertz / 1e3)
        .collect()
}

fn kilohertz(core: &Path) -> Option<f64> {
    fs::read_to_string(core.join("cpufreq/scaling_cur_freq")).ok()?.trim().parse().ok()
}

fn range(values: impl Iterator<Item = f64>) -> Option<RangeInclusive<f64>> {
    values
        .map(|value| value..=value)
        .reduce(|a, b| a.start().min(*b.start())..=a.end().max(*b.end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_all_processors() {
        let stat = "cpu  100 20 30 40000000000 500 6 7 8 9 10\ncpu0 1 2 3 4 5 6 7 8 9 10\n";
        let expected =
            Times { busy: Duration::from_millis(1630), stolen: Duration::from_millis(80) };
        assert_eq!(Times::of(stat), Some(expected));
        for nonsense in ["", "cpu0 1 2 3 4 5 6 7 8", "cpu 1 2 3", "cpu a b c d e f g h"] {
            assert_eq!(Times::of(nonsense), None, "{nonsense}");
        }
    }

    #[test]
    fn throttling_is_counted() {
        assert_eq!(times_throttled("nr_periods 9\nnr_throttled 4\nthrottled_usec 7\n"), Some(4));
        assert_eq!(times_throttled("usage_usec 9\n"), None);
    }

    #[test]
    fn others_disturb_above_their_share() {
        let noise = |foreign, stolen, throttled| Noise {
            wall: Duration::from_secs(10),
            cores: 2,
            foreign: Some(Duration::from_millis(foreign)),
            stolen: Some(Duration::from_millis(stolen)),
            throttled,
            ..Noise::default()
        };
        // 2 % of two cores for ten seconds are 400 ms.
        assert!(!noise(300, 90, Some(0)).is_disturbing());
        assert!(noise(300, 110, Some(0)).is_disturbing() && noise(0, 0, Some(1)).is_disturbing());
        assert_eq!(noise(4000, 1000, None).share_of_others(), Some(0.25));
        let unknown = Noise { wall: Duration::from_secs(1), cores: 2, ..Noise::default() };
        assert!(!unknown.is_disturbing() && unknown.share_of_others().is_none());
    }

    #[test]
    fn lowest_and_highest() {
        assert_eq!(range([2.0, 1.0, 3.0].into_iter()), Some(1.0..=3.0));
        assert_eq!(range(std::iter::empty()), None);
    }

    /// Catches our own work taken for somebody else's.
    #[cfg(target_os = "linux")]
    #[test]
    fn our_own_time_is_not_foreign() {
        let stat = || {
            Times::of(&fs::read_to_string("/proc/stat").expect("Linux"))
                .expect("its first line")
                .busy
        };
        let (busy_before, watch) = (stat(), Watch::start());
        let before = Usage::of_this_process().expect("Linux").cpu;
        while Usage::of_this_process().expect("Linux").cpu < before + Duration::from_millis(100) {}
        let (foreign, busy) = (watch.finish(1).foreign.expect("Linux"), stat() - busy_before);
        // All that was done, less what we did; ticks are coarse.
        let coarseness = Duration::from_millis(4 * TICK_MS);
        assert!(
            foreign + Duration::from_millis(100) <= busy + coarseness,
            "{foreign:?} of {busy:?}"
        );
    }
}
