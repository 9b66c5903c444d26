//! What a command measures, and what the machine did in the meantime.

use crate::progress::Share;
use rayweave_measure::Machine;
use rayweave_measure::noise::{Noise, Watch};

/// What `measure` gives, which shows on the bar how far it is; where that was, and what else went
/// on there.
pub fn watched<T>(measure: impl FnOnce(&Share) -> T) -> (T, Machine, Noise) {
    let (bar, watch) = (Share::new(), Watch::start());
    let result = measure(&bar);
    let machine = Machine::here();
    let noise = watch.finish(machine.logical_cores);
    (result, machine, noise)
}
