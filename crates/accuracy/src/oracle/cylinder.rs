//! Exact intersection with a cylinder: the closest root ahead of the origin on the circle seen from
//! above, at a height between the rims.

use dashu_ratio::RBig;

use super::Trace;
use super::exact::{Surd, Vector, float, sign};
use super::margin;
use super::quadric::{Quadric, is_ahead};

/// A condition on a root, and its margin.
struct Condition {
    holds: bool,
    margin: f64,
}

/// Intersects a ray with a cylinder; `axis` holds its lower and its upper end.
pub(super) fn trace(
    axis: &[Vector; 2],
    radius: &RBig,
    origin: &Vector,
    direction: &Vector,
) -> Trace {
    let [bottom, top] = axis;
    if sign(radius).is_le() || bottom[1] > top[1] {
        return Trace::miss("no radius or height", f64::INFINITY);
    }
    if bottom[0] != top[0] || bottom[2] != top[2] {
        return Trace::miss("askew", f64::INFINITY);
    }
    let [d_x, d_y, d_z] = direction;
    if d_x.is_zero() && d_z.is_zero() {
        return Trace::miss("parallel to the axis", f64::INFINITY);
    }
    let from_axis = [&origin[0] - &bottom[0], &origin[2] - &bottom[2]];
    let quadric = Quadric::new(from_axis, [d_x.clone(), d_z.clone()], radius.clone());
    if !quadric.is_met() {
        return Trace::miss("beside", quadric.approach_margin());
    }
    let side_margin = quadric.side_margin();
    // The margin of the decisions on earlier roots.
    let mut so_far = f64::INFINITY;
    for t in quadric.roots() {
        let cond = quadric.condition(&t);
        // The condition that the hit is on the inner side of a rim.
        let within_rim = |start: RBig, d_y: &RBig| {
            let height = t.times(d_y).plus(&start);
            Condition {
                holds: height.sign().is_ge(),
                margin: rim_margin(&height, &start, d_y, &t, cond),
            }
        };
        let conditions = [
            Condition { holds: is_ahead(&t), margin: side_margin },
            within_rim(&origin[1] - &bottom[1], d_y),
            within_rim(&top[1] - &origin[1], &-d_y),
        ];
        if conditions.iter().all(|condition| condition.holds) {
            let margin = conditions.iter().map(|condition| condition.margin).fold(so_far, f64::min);
            let [n_x, n_z] = quadric.normal(&t);
            let normal = [n_x, Surd::rational(RBig::ZERO), n_z];
            return Trace::hit(t, cond, normal, margin.min(quadric.meeting_margin()));
        }
        let broken = conditions.iter().filter(|condition| !condition.holds);
        so_far = so_far.min(broken.map(|condition| condition.margin).fold(0.0, f64::max));
    }
    Trace::miss("behind, above or below", so_far)
}

/// Returns the margin of the sign of `height = start + t d_y`. Here `start` and `d_y` are inputs,
/// and `t` depends on its own inputs with the condition number `cond`.
fn rim_margin(height: &Surd, start: &RBig, d_y: &RBig, t: &Surd, cond: f64) -> f64 {
    let climb = t.times(d_y).size();
    let follows = if climb == 0.0 { 0.0 } else { climb * (1.0 + cond) };
    margin::in_ulps(height.size(), float(start).abs() + follows)
}
