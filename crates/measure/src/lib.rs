//! Checks that strategies agree, and measures, explains and predicts their times. Prints nothing.
//!
//! * [`check`]: compares every strategy with the reference, bit for bit, and finds the pixel, the
//!   tile and the thread of a difference;
//! * [`compare`]: times strategies in interleaved rounds and verifies every timed image;
//! * [`overhead`]: measures the cost of a strategy beside its work, on synthetic work;
//! * [`forecast`]: predicts speed-ups on more threads than the machine has;
//! * [`explanation`]: splits the efficiency that a strategy loses by cause, from a breakdown of
//!   every thread's time ([`efficiency`]);
//! * [`machine`]: the facts about the machine and the program of a measurement;
//! * [`noise`]: the other activity on the machine during a measurement.
//!
//! An observer of a rendering is a [`Work`](rayweave_contract::Work) around a `Work` ([`recorder`],
//! [`timeline`]) or in place of it ([`computing_threads`]). Strategies have no code for it.

pub mod calibration;
mod catch_panic;
pub mod check;
pub mod compare;
pub mod computing_threads;
mod digest_text;
pub mod efficiency;
pub mod explanation;
#[cfg(test)]
mod fakes;
pub mod finding;
pub mod forecast;
pub mod in_process;
pub mod independent;
pub mod machine;
pub mod measurement;
pub mod noise;
pub mod overhead;
pub mod piece_costs;
pub mod random;
pub mod recorder;
pub mod rounds;
mod sentinel;
pub mod statistics;
pub mod synthetic;
pub mod tile_costs;
mod timed_image;
pub mod timeline;
pub mod usage;

pub use check::{Check, CheckCase, Verdict};
pub use compare::{Comparison, Entry};
pub use finding::{Fault, Finding};
pub use forecast::Forecast;
pub use in_process::InProcessExecutor;
pub use machine::Machine;
pub use measurement::Measurement;
pub use noise::Noise;
pub use rounds::Protocol;
pub use statistics::Interval;
pub use tile_costs::TileCosts;
