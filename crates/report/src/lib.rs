//! Results to terminal, JSON, CSV and SVG. Everything here returns text; nothing prints.
//!
//! * [`compare::Report`]: the table of a comparison, and the same for other programs;
//! * [`check`]: what a check found;
//! * [`explain::Report`]: why strategies lose;
//! * [`accuracy`]: how right a kernel's answers to hard cases are;
//! * [`tradeoff::Report`]: speed against error, as a table, a plot, and for other programs;
//! * [`overhead::Report`]: what strategies cost beside their work;
//! * [`forecast::Report`]: what more threads would do, as tables, a plot, and for other programs.

pub mod accuracy;
pub mod check;
pub mod compare;
mod csv;
pub mod explain;
pub mod forecast;
mod json;
pub mod machine;
mod noise;
pub mod overhead;
mod style;
pub mod tradeoff;
