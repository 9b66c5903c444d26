//! Accuracy of the tracer: images compared with a reference, and single rays with exact answers.
//!
//! This crate prints nothing. Images:
//!
//! * [`tradeoff`]: times every setting of the tracer and measures its error;
//! * [`metrics`]: measures of the difference between two images, and [`flip`], the visible one.
//!
//! Hard cases of rays and primitives:
//!
//! * [`cases`] and [`outcomes`]: the cases and the answers of a kernel, in files of [`json_lines`];
//! * [`oracle`]: computes the exact answer to a case by rational arithmetic;
//! * [`families`]: seeded generators of 36 families of hard cases, with their answers;
//! * [`shadows`]: whether a surface hides a light that lies in it or close to it;
//! * [`ties`]: which of the surfaces in one plane is seen;
//! * [`kernel`]: runs the tracer's own kernel on a case;
//! * [`mod@score`]: verdicts, errors in ulps and leaks per family, and their [`thresholds`];
//! * [`guarantees`]: the properties that hold for any ray and primitive, for fuzzing.
//!
//! The definition of a hit:
//!
//! * A ray is `origin + t direction`. The direction may have any length, and `t` is in units of it.
//! * A hit needs `t > 0`, and the smallest such `t` counts. A ray that starts on a surface does not
//!   hit it there.
//! * A plane and a triangle have two sides, and a ray in their plane misses them. The edges and
//!   vertices of a triangle belong to it. A triangle without area is never hit.
//! * A sphere is hit by its tangents.
//! * A cylinder is a wall without caps around an axis parallel to y, and includes both rims. A ray
//!   parallel to the axis misses it.
//! * Input that contains one of these is a miss: a number that is not finite, a direction or a
//!   normal of zero, a radius of 0 or less, a cylinder upside down or askew.

pub mod cases;
pub mod decimal;
pub mod families;
pub mod flip;
pub mod guarantees;
pub mod json_lines;
pub mod kernel;
pub mod metrics;
mod number;
pub mod oracle;
pub mod outcomes;
pub mod score;
pub mod shadows;
pub mod thresholds;
pub mod ties;
pub mod tradeoff;

pub use cases::{Expect, HardCase, Primitive, Ray};
pub use decimal::Decimal;
pub use families::{FAMILIES, Family, generate};
pub use json_lines::ReadError;
pub use metrics::ImageDifference;
pub use oracle::{ExactAnswer, answer};
pub use outcomes::Outcome;
pub use score::{FamilyScore, score};
pub use thresholds::Tier;
