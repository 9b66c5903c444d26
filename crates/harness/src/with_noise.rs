//! Runs a measurement and records the machine and its noise meanwhile.

use crate::progress::Share;
use rayweave_measure::Machine;
use rayweave_measure::noise::{Noise, NoiseMonitor};

/// Runs `measure`, which shows its progress on the bar. Returns its result, the machine, and the
/// other activity on it.
pub fn with_noise<T>(measure: impl FnOnce(&Share) -> T) -> (T, Machine, Noise) {
    let (bar, monitor) = (Share::new(), NoiseMonitor::start());
    let result = measure(&bar);
    let machine = Machine::here();
    let noise = monitor.finish(machine.logical_cores);
    (result, machine, noise)
}
