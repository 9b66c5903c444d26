//! How right is it: images against the truth, and single rays against exact answers. Prints
//! nothing.
//!
//! * [`tradeoff`]: every setting of the tracer, its time and its error;
//! * [`metrics`]: how far an image is from another, and [`flip`], as one sees it.
//!
//! Hard cases of rays and primitives:
//!
//! * [`cases`]: the case format, JSON lines read and written;
//! * [`oracle`]: the exact answer to a case, by rational arithmetic;
//! * [`families`]: seeded generators of 36 families of hard cases, with their answers;
//! * [`kernel`]: what the tracer's own answers;
//! * [`outcomes`]: what a kernel answered, one JSON line a case;
//! * [`mod@score`]: verdicts, errors in ulps and leaks a family, and [`thresholds`] for them;
//! * [`guarantees`]: what holds for any ray and primitive, for fuzzing.
//!
//! What is right:
//!
//! * a ray is `origin + t direction`, the direction of any length, `t` in units of it;
//! * a hit needs `t > 0`, and the smallest such `t` counts; a ray that starts on a surface does not
//!   hit it there;
//! * a plane and a triangle have two sides; a ray in their plane misses them; a triangle's edges
//!   and vertices belong to it, and a triangle without area is never hit;
//! * a sphere is touched by its tangents;
//! * a cylinder is a wall without caps around an axis parallel to y, both rims included; a ray
//!   parallel to the axis misses it;
//! * a number that is not finite, a direction or a normal of zero, a radius of 0 or less, a
//!   cylinder upside down or askew is a miss.

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
pub mod thresholds;
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
