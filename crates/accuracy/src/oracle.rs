//! The oracle: computes the exact answer to a case by rational arithmetic.
//!
//! Every input is an f32, hence a fraction, so the true answer is a mathematical fact. All verdicts
//! (hit or miss, which root, inside which edge) are signs of fractions or of `p + s sqrt(d)` with
//! fractions `p`, `s` and `d`. Rational arithmetic alone decides them. The numbers of the answer
//! are such expressions too; their roots are computed, to 512 bits, only to write them down.
//!
//! Three more numbers state how hard a case is for a kernel in f32. Every kernel begins with the
//! differences of positions (from origin to centre, to vertex ...), so the relevant inputs `x_i`
//! are these differences, the direction and the radius.
//!
//! * `cond`, the relative condition number of `t`: `sum_i |x_i dt/dx_i| / t`. A backward stable
//!   kernel errs by a small multiple of `cond` ulps (Higham, "Accuracy and Stability of Numerical
//!   Algorithms", 2nd ed., section 1.6).
//! * `margin`: a verdict changes where some `g(x) = 0`. The distance from there, to first order, is
//!   `|g| / sum_i |x_i dg/dx_i|`, in ulps of 2^-23. The margin of a hit is that of its closest
//!   boundary. The margin of a miss with several reasons is the largest of theirs.
//! * `decidable`: the margin is 4 or more. The margin is infinite where f32 arithmetic computes a
//!   `g` of 0 without rounding, and where a triangle has no area, so a kernel must be right there.
//!   A hit of a mesh is always decidable: rounding may choose either of two triangles that share an
//!   edge, but it must choose one.

mod cylinder;
mod exact;
mod margin;
mod plane;
mod quadric;
pub mod shadow;
mod sphere;
mod triangle;

use crate::cases::{Expect, Primitive, Ray};

use exact::{Surd, Vector};

/// The smallest margin, in ulps, at which a good f32 kernel must be right.
pub const DECIDABLE_MARGIN: f64 = 4.0;
/// The value for infinity in [`ExactAnswer::cond`] and [`ExactAnswer::margin`], which JSON lacks.
pub const INFINITE: f64 = 9.9e99;

/// The exact answer to a case, and the difficulty of the case.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactAnswer {
    /// The answer.
    pub expect: Expect,
    /// The relative condition number of `t`, to four digits, at most [`INFINITE`]; 0 on a miss.
    pub cond: f64,
    /// The distance to the closest other verdict in f32 ulps, to four digits, at most [`INFINITE`].
    pub margin: f64,
    /// True if a good f32 kernel must get the verdict right.
    pub decidable: bool,
    /// The reason for a miss; empty on a hit.
    pub reason: &'static str,
}

/// The result for one ray and one primitive, before rounding.
struct Trace {
    hit: Option<Hit>,
    margin: f64,
    reason: &'static str,
}

/// The hit of a ray.
struct Hit {
    t: Surd,
    cond: f64,
    normal: [Surd; 3],
}

impl Trace {
    fn hit(t: Surd, cond: f64, normal: [Surd; 3], margin: f64) -> Self {
        Self { hit: Some(Hit { t, cond, normal }), margin, reason: "" }
    }

    fn miss(reason: &'static str, margin: f64) -> Self {
        Self { hit: None, margin, reason }
    }
}

/// Returns the exact answer to a ray against a primitive. It is defined for every input, finite or
/// not; the documentation of the crate states the rules for unusual input.
#[must_use]
pub fn answer(primitive: &Primitive, ray: &Ray) -> ExactAnswer {
    let mesh = matches!(primitive, Primitive::Mesh { .. });
    let (trace, expect) = match trace_finite(primitive, ray) {
        Some((trace, expect)) => (trace, expect),
        None => (Trace::miss("non-finite input", f64::INFINITY), Expect::Miss),
    };
    ExactAnswer {
        decidable: trace.margin >= DECIDABLE_MARGIN || (mesh && expect.is_hit()),
        expect,
        cond: four_digits(trace.hit.map_or(0.0, |hit| hit.cond)),
        margin: four_digits(trace.margin),
        reason: trace.reason,
    }
}

/// Returns `None` if a number is not finite.
fn trace_finite(primitive: &Primitive, ray: &Ray) -> Option<(Trace, Expect)> {
    let (origin, direction) = (exact::vector(ray.origin)?, exact::vector(ray.direction)?);
    let trace = if exact::is_zero(&direction) {
        Trace::miss("zero direction", f64::INFINITY)
    } else {
        trace_primitive(primitive, &origin, &direction)?
    };
    let expect = match (&trace.hit, primitive) {
        (None, _) => Expect::Miss,
        (Some(hit), Primitive::Mesh { .. }) => Expect::MeshHit { t: hit.t.decimal() },
        (Some(hit), _) => Expect::Hit {
            t: hit.t.decimal(),
            point: Box::new(std::array::from_fn(|i| {
                hit.t.times(&direction[i]).plus(&origin[i]).decimal()
            })),
            normal: Box::new(hit.normal.each_ref().map(Surd::decimal)),
        },
    };
    Some((trace, expect))
}

fn trace_primitive(primitive: &Primitive, origin: &Vector, direction: &Vector) -> Option<Trace> {
    Some(match primitive {
        Primitive::Plane { point, normal } => {
            plane::trace(&exact::vector(*point)?, &exact::vector(*normal)?, origin, direction)
        }
        Primitive::Sphere { center, radius } => {
            sphere::trace(&exact::vector(*center)?, &exact::number(*radius)?, origin, direction)
        }
        Primitive::Triangle { a, b, c } => {
            let vertices = [exact::vector(*a)?, exact::vector(*b)?, exact::vector(*c)?];
            triangle::trace(&vertices, origin, direction)
        }
        Primitive::Cylinder { bottom, top, radius } => {
            let axis = [exact::vector(*bottom)?, exact::vector(*top)?];
            cylinder::trace(&axis, &exact::number(*radius)?, origin, direction)
        }
        Primitive::Mesh { triangles } => trace_mesh(triangles, origin, direction),
    })
}

/// Returns the closest hit of all triangles. A triangle with a non-finite number is left out.
fn trace_mesh(triangles: &[[[f32; 3]; 3]], origin: &Vector, direction: &Vector) -> Trace {
    let mut closest = Trace::miss("no triangle", f64::INFINITY);
    for &[a, b, c] in triangles {
        let triangle = Primitive::Triangle { a, b, c };
        let Some(trace) = trace_primitive(&triangle, origin, direction) else { continue };
        match (&closest.hit, &trace.hit) {
            (None, None) => closest.margin = closest.margin.min(trace.margin),
            (None, Some(_)) => closest = trace,
            (Some(old), Some(new)) if new.t.is_less_rational(&old.t) => closest = trace,
            (Some(_), _) => {}
        }
    }
    closest
}

/// Rounds to four significant digits, which are short to write and enough to judge by.
fn four_digits(value: f64) -> f64 {
    let value = value.min(INFINITE);
    // A formatted number always parses.
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Returns `n / |n|`.
fn unit(n: &Vector) -> [Surd; 3] {
    let length_squared = exact::dot(n, n);
    n.each_ref().map(|component| Surd::root(component / &length_squared, length_squared.clone()))
}
