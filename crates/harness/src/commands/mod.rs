//! One file a subcommand.

pub mod check;
pub mod compare;
pub mod error;
pub mod intersect;
pub mod render;
pub mod sample;
pub mod strategies;
