//! Exact intersection with a plane: `t = (q - o).n / d.n` with a point `q` and the normal `n`.

use super::exact::{
    Surd, Vector, abs, float, is_zero, products, sign, subtract, sum, sum_of_sizes,
};
use super::{Trace, margin, unit};

pub(super) fn trace(point: &Vector, normal: &Vector, origin: &Vector, direction: &Vector) -> Trace {
    if is_zero(normal) {
        return Trace::miss("zero normal", f64::INFINITY);
    }
    let height_terms = products(&subtract(point, origin), normal);
    let slope_terms = products(direction, normal);
    let (height, slope) = (sum(&height_terms), sum(&slope_terms));
    let slope_margin = margin::of_sum(&slope_terms);
    if slope.is_zero() {
        return Trace::miss("parallel", slope_margin);
    }
    let margin = slope_margin.min(margin::of_sum(&height_terms));
    if sign(&height) != sign(&slope) {
        return Trace::miss("behind", margin);
    }
    let cond =
        sum_of_sizes(&height_terms) / abs(&height) + sum_of_sizes(&slope_terms) / abs(&slope);
    Trace::hit(Surd::rational(height / slope), float(&cond), unit(normal), margin)
}
