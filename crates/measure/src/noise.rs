//! Observes the machine during a measurement: other programs, the hypervisor, limits, clock rates.
//!
//! All figures come from `/proc` and `/sys` of Linux; those that are not there are unknown.

use crate::machine::cpu_groups;
use crate::usage::Usage;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// The length of a tick in `/proc/stat`, in milliseconds. It does not depend on the kernel's timer.
const TICK_MS: u64 = 10;

/// The share of the machine that others may use before a measurement counts as disturbed.
const QUIET: f64 = 0.02;

/// The other activity on the machine during a measurement; `None` where the system does not tell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Noise {
    /// The duration of the measurement, in seconds.
    pub wall_s: f64,
    /// The CPU time of all other programs on the machine, those in other containers included, in
    /// seconds.
    pub foreign_cpu_s: Option<f64>,
    /// The time that a hypervisor gave to other machines while this one had something to do, in
    /// seconds.
    pub stolen_s: Option<f64>,
    /// The share of the machine that other programs and other machines had: 0 to 1.
    pub share_of_others: Option<f64>,
    /// The number of times that the control group's limit stopped this process and its neighbours
    /// in the group.
    pub throttled: Option<u64>,
    /// The number of times that one of our threads lost its core while it had something to do.
    pub involuntary_switches: Option<u64>,
    /// The lowest clock rate of a core at the beginning and at the end, in MHz.
    pub lowest_mhz: Option<f64>,
    /// The highest clock rate of a core at the beginning and at the end, in MHz.
    pub highest_mhz: Option<f64>,
    /// True if the times are unreliable: others had more than 2 % of the machine, or the limit was
    /// reached.
    pub disturbed: bool,
}

impl Noise {
    /// Computes the share of others and `disturbed` from the counts, on a machine of `cores`
    /// logical cores.
    #[must_use]
    fn judged(self, cores: usize) -> Self {
        let capacity = (self.wall_s * cores.max(1) as f64).max(f64::MIN_POSITIVE);
        let others = self.foreign_cpu_s.map(|foreign| foreign + self.stolen_s.unwrap_or_default());
        let share_of_others = others.map(|others| (others / capacity).min(1.0));
        let throttled = self.throttled.is_some_and(|times| times > 0);
        let disturbed = throttled || share_of_others.is_some_and(|share| share > QUIET);
        Self { share_of_others, disturbed, ..self }
    }
}

/// Observes the machine from [`NoiseMonitor::start`] to [`NoiseMonitor::finish`].
#[derive(Debug)]
pub struct NoiseMonitor {
    begin: Instant,
    before: Counters,
}

impl NoiseMonitor {
    /// Starts to observe.
    #[must_use]
    pub fn start() -> Self {
        Self { begin: Instant::now(), before: Counters::now() }
    }

    /// Returns the noise since the start, on a machine of `cores` logical cores.
    #[must_use]
    pub fn finish(&self, cores: usize) -> Noise {
        let (wall, before, after) = (self.begin.elapsed(), &self.before, Counters::now());
        let own = after.own.zip(before.own).map(|(after, before)| after.since(before));
        let times = after.times.zip(before.times);
        let busy = times.map(|(after, before)| after.busy.saturating_sub(before.busy));
        let foreign = busy.zip(own).map(|(busy, own)| busy.saturating_sub(own.cpu));
        let stolen = times.map(|(after, before)| after.stolen.saturating_sub(before.stolen));
        let throttled = after.throttled.zip(before.throttled);
        let megahertz = || before.megahertz.iter().chain(&after.megahertz).copied();
        let noise = Noise {
            wall_s: wall.as_secs_f64(),
            foreign_cpu_s: foreign.map(|time| time.as_secs_f64()),
            stolen_s: stolen.map(|time| time.as_secs_f64()),
            throttled: throttled.map(|(after, before)| after.saturating_sub(before)),
            involuntary_switches: own.map(|own| own.involuntary_switches),
            lowest_mhz: megahertz().reduce(f64::min),
            highest_mhz: megahertz().reduce(f64::max),
            ..Noise::default()
        };
        noise.judged(cores)
    }
}

/// The counters of the system at one moment.
#[derive(Debug)]
struct Counters {
    times: Option<Times>,
    own: Option<Usage>,
    throttled: Option<u64>,
    megahertz: Vec<f64>,
}

impl Counters {
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

/// The time that all processors together were busy, or stolen by the hypervisor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Times {
    busy: Duration,
    stolen: Duration,
}

impl Times {
    /// Parses the line "cpu user nice system idle iowait irq softirq steal ..." of `/proc/stat`,
    /// in ticks.
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

/// Returns the number of times that the control groups of this process have been throttled.
fn throttled() -> Option<u64> {
    let stats = cpu_groups()
        .into_iter()
        .filter_map(|(_, folder)| fs::read_to_string(folder.join("cpu.stat")).ok());
    stats.filter_map(|stat| times_throttled(&stat)).reduce(|a, b| a + b)
}

fn times_throttled(stat: &str) -> Option<u64> {
    stat.lines().find_map(|line| line.strip_prefix("nr_throttled "))?.trim().parse().ok()
}

/// Returns the current clock rate of each core, in MHz.
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
        let noise = |foreign_cpu_s, stolen_s, throttled| {
            let (foreign_cpu_s, stolen_s) = (Some(foreign_cpu_s), Some(stolen_s));
            Noise { wall_s: 10.0, foreign_cpu_s, stolen_s, throttled, ..Noise::default() }.judged(2)
        };
        // 2 % of two cores for ten seconds are 0.4 s.
        assert!(!noise(0.3, 0.09, Some(0)).disturbed);
        assert!(noise(0.3, 0.11, Some(0)).disturbed && noise(0.0, 0.0, Some(1)).disturbed);
        assert_eq!(noise(4.0, 1.0, None).share_of_others, Some(0.25));
        let unknown = Noise { wall_s: 1.0, ..Noise::default() }.judged(2);
        assert!(!unknown.disturbed && unknown.share_of_others.is_none());
    }

    /// Catches CPU time of this process counted as that of other programs.
    #[cfg(target_os = "linux")]
    #[test]
    fn our_own_time_is_not_foreign() {
        let stat = || {
            Times::of(&fs::read_to_string("/proc/stat").expect("Linux"))
                .expect("its first line")
                .busy
        };
        let (busy_before, monitor) = (stat(), NoiseMonitor::start());
        let before = Usage::of_this_process().expect("Linux").cpu;
        while Usage::of_this_process().expect("Linux").cpu < before + Duration::from_millis(100) {}
        let (foreign, busy) =
            (monitor.finish(1).foreign_cpu_s.expect("Linux"), stat() - busy_before);
        // All busy time less that of this process; ticks are coarse.
        let coarseness = Duration::from_millis(4 * TICK_MS);
        assert!(
            Duration::from_secs_f64(foreign) + Duration::from_millis(100) <= busy + coarseness,
            "{foreign:?} of {busy:?}"
        );
    }
}
