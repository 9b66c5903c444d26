//! Rendering: the samples of each pixel, where they lie, and how they become the pixel's colour.

pub(crate) mod adaptive;
pub(crate) mod filter;
pub(crate) mod lattice;
pub(crate) mod sample_count;
pub(crate) mod samples;
pub(crate) mod tracer;
