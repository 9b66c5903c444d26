//! The tracer: a [`Scene`] as [`Work`](rayweave_contract::Work).
//!
//! * [`Scene`] says what is drawn, in `f64`; [`tracer()`] turns it into work.
//! * Inside, a formula is written once over a number type (`simd`); `accel` finds what a ray
//!   hits, `trace` the colour that the ray brings back, and `render` filters samples into pixels.
//!
//! This crate starts no thread, opens no file and reads no clock.

mod accel;
pub mod analysis;
mod camera;
pub mod cast;
mod execution;
mod fault;
mod formulas;
mod material;
pub mod precision;
#[cfg(test)]
mod random;
mod ray;
mod render;
pub mod scene;
mod settings;
mod shapes;
mod simd;
mod trace;

pub use analysis::Analysis;
pub use cast::Caster;
pub use execution::{Acceleration, Execution, Lanes};
pub use render::sample_count::primary_rays;
pub use render::tracer::tracer;
pub use scene::Scene;
pub use settings::{Arithmetic, Formulas, Precision, Sampling};
