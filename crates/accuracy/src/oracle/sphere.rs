//! Exact intersection with a sphere: the closest root of `|o + t d - c| = r` ahead of the origin.

use dashu_ratio::RBig;

use super::Trace;
use super::exact::{Vector, sign, subtract};
use super::quadric::{Quadric, is_ahead};

pub(super) fn trace(center: &Vector, radius: &RBig, origin: &Vector, direction: &Vector) -> Trace {
    if sign(radius).is_le() {
        return Trace::miss("no radius", f64::INFINITY);
    }
    let quadric = Quadric::new(subtract(origin, center), direction.clone(), radius.clone());
    if !quadric.is_met() {
        return Trace::miss("beside", quadric.approach_margin());
    }
    let side_margin = quadric.side_margin();
    match quadric.roots().into_iter().find(is_ahead) {
        Some(t) => {
            let (cond, normal) = (quadric.condition(&t), quadric.normal(&t));
            Trace::hit(t, cond, normal, side_margin.min(quadric.meeting_margin()))
        }
        None => Trace::miss("behind", side_margin),
    }
}
