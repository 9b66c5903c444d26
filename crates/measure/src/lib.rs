//! Proof that strategies agree, and the timing protocol with its statistics. Prints nothing.
//!
//! * [`check`]: every strategy against the reference, bit for bit, with the pixel, the tile and the
//!   thread that differ;
//! * [`compare`]: interleaved rounds in which every timed picture is verified;
//! * [`machine`]: what was measured on, and with what;
//! * [`noise`]: what else went on at the time.
//!
//! What watches a rendering is a [`Work`](rayweave_core::Work) around a `Work` ([`recorder`]) or
//! in place of it ([`computing_threads`]): no strategy has a line for any of it.

mod attempt;
pub mod check;
pub mod compare;
pub mod computing_threads;
pub mod finding;
pub mod load;
pub mod machine;
pub mod noise;
mod poison;
pub mod random;
pub mod recorder;
pub mod schedule;
pub mod statistics;
pub mod stopwatch;
pub mod usage;

pub use check::{Case, Check, Verdict};
pub use compare::{Comparison, Entry, Row};
pub use finding::{Fault, Finding};
pub use load::Load;
pub use machine::Machine;
pub use noise::Noise;
pub use schedule::Protocol;
pub use statistics::Interval;
pub use stopwatch::Stopwatch;
