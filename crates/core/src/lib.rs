//! The tracer: a [`Scene`] as [`Work`](rayweave_contract::Work).
//!
//! * [`Scene`] says what is drawn, in `f64`; [`tracer()`] turns it into work.
//! * Inside, a formula is written once over a number type (`lane`); `primitives` finds what a ray
//!   hits, `trace` the colour that the ray brings back, and `tracer` filters samples into pixels.
//!
//! This crate starts no thread, opens no file and reads no clock.

mod adaptive;
pub mod analysis;
mod antialiasing;
mod bundle;
mod camera;
pub mod cast;
mod confinement;
mod enclosure;
pub mod execution;
pub mod formulas;
mod in_front;
mod kind;
mod lane;
#[cfg(test)]
mod lane_identity;
mod lattice;
mod material;
mod packet;
pub mod precision;
mod primitives;
#[cfg(test)]
mod random;
mod ray;
mod sample_count;
mod samples;
pub mod scene;
mod shapes;
mod trace;
pub mod tracer;
mod tree;
mod vector;

pub use analysis::Analysis;
pub use cast::Caster;
pub use execution::{Execution, Lanes, Search};
pub use formulas::{Arithmetic, Formulas};
pub use precision::Precision;
pub use sample_count::primary_rays;
pub use scene::{Sampling, Scene};
pub use tracer::tracer;
