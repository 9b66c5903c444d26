//! Predicts the time of a strategy on any number of threads from its policy, by simulation, and
//! fits laws of speed-up.
//!
//! * [`simulate`]: replays the costs of pieces under a [`Policy`](rayweave_contract::Policy);
//! * [`fit`]: fits Amdahl's law and Gunther's by least squares.
//!
//! This crate starts no thread and reads no clock. The caller measures the costs.

pub mod fit;
mod scheduler;
pub mod simulation;

pub use fit::Law;
pub use simulation::{Access, Overheads, SimulatedRender, simulate};
