//! Proof that strategies agree, and the timing protocol with its statistics. Prints nothing.
//!
//! * [`check`]: every strategy against the reference, bit for bit, with the pixel, the tile and the
//!   thread that differ;
//! * [`compare`]: interleaved rounds in which every timed image is verified;
//! * [`overhead`]: what a strategy costs beside its work, on synthetic work;
//! * [`forecast`]: what more threads would make of an image, beside what those here make of it;
//! * [`explanation`]: what becomes of the efficiency that a strategy loses, by an account of every
//!   thread's time ([`efficiency`]);
//! * [`machine`]: what was measured on, and with what;
//! * [`noise`]: what else went on at the time.
//!
//! What watches a rendering is a [`Work`](rayweave_contract::Work) around a `Work` ([`recorder`],
//! [`timeline`]) or in place of it ([`computing_threads`]): no strategy has a line for any of it.

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
