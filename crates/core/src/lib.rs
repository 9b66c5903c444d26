//! The ray tracer: renders a [`Scene`] as [`Work`](rayweave_contract::Work).
//!
//! * A [`Scene`] is plain data in `f64`; [`tracer()`] turns it into work.
//! * [`RenderSettings`](scene::RenderSettings), in the scene, change the image; an [`Execution`]
//!   never does.
//! * Every formula is written once over a number type (`simd`). `accel` finds what a ray hits,
//!   `trace` finds the colour that the ray brings back, and `render` filters samples into pixels.
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
pub use render::sample_count::{primary_packets, primary_rays};
pub use render::tracer::tracer;
pub use scene::Scene;
pub use settings::{Arithmetic, Formulas, Precision, Sampling};
