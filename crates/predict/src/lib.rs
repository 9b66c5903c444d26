//! Forecasts of a strategy's policy for more threads: a simulation, and the laws fitted to it.
//!
//! * [`simulate`]: replays the costs of pieces under a [`Policy`](rayweave_contract::Policy);
//! * [`fit`]: Amdahl's law and Gunther's, by least squares.
//!
//! This crate starts no thread and reads no clock: what things cost is measured elsewhere.

pub mod fit;
mod scheduler;
pub mod simulation;

pub use fit::Law;
pub use simulation::{Access, Overheads, SimulatedRender, simulate};
