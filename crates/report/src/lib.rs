//! Results to terminal, JSON and CSV. Everything here returns text; nothing prints.
//!
//! * [`compare::Report`]: the table of a comparison, and the same for other programs;
//! * [`check`]: what a check found;
//! * [`accuracy`]: how right a kernel's answers to hard cases are.

pub mod accuracy;
pub mod check;
pub mod compare;
mod json;
pub mod machine;
