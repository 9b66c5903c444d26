//! The subcommands, one in each file.

pub mod check;
pub mod compare;
pub mod explain;
pub mod intersect;
pub mod overhead;
pub mod predict;
pub mod render;
pub mod sample;
pub mod strategies;
pub mod tradeoff;
