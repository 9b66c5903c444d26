//! The results of every command as text: for a terminal, as JSON, CSV, Markdown and SVG. Functions
//! return text; nothing prints.
//!
//! * [`compare::Results`]: the list of measurements of a comparison, and its views;
//! * [`check`]: the verdict of a check;
//! * [`explain::ExplanationView`]: where the time of the threads goes;
//! * [`accuracy`]: the score of a kernel on hard cases;
//! * [`tradeoff::TradeoffView`]: speed against error;
//! * [`overhead::OverheadView`]: the costs of a strategy beyond its work;
//! * [`forecast::ForecastView`]: predicted speed-ups for more threads.

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
mod plot;
mod style;
pub mod tradeoff;
