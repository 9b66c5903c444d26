//! Results as text: terminal, JSON, CSV, Markdown and SVG. Everything here returns text; nothing
//! prints.
//!
//! * [`compare::Results`]: the list of measurements of a comparison, and its views;
//! * [`check`]: the findings of a check;
//! * [`explain::Report`]: why strategies lose;
//! * [`accuracy`]: errors of a kernel on hard cases;
//! * [`tradeoff::Report`]: speed against error;
//! * [`overhead::Report`]: what strategies cost beside their work;
//! * [`forecast::Report`]: speed-ups predicted for more threads.

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
