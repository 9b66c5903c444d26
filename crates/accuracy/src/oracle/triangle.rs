//! Exact intersection with a triangle: `t = (a - o).n / d.n` with `n = (b - a) x (c - a)`. The ray
//! hits where the signed volumes that it spans with the three edges do not differ in sign.

use std::cmp::Ordering;

use dashu_ratio::RBig;

use super::exact::{
    Surd, Vector, abs, cross, cross_products, dot, dot_of_sizes, float, is_zero, products, sign,
    subtract, sum, sum_of_sizes,
};
use super::{Trace, margin, unit};

/// The side of an edge on which the ray passes, and the margin.
struct Edge {
    side: Ordering,
    margin: f64,
}

pub(super) fn trace(vertices: &[Vector; 3], origin: &Vector, direction: &Vector) -> Trace {
    let [a, b, c] = vertices;
    let (ab, ac) = (subtract(b, a), subtract(c, a));
    let normal_products = cross_products(&ab, &ac);
    let normal_exact = normal_products.iter().all(|pair| margin::computed_exactly(pair));
    let normal_sizes = normal_products.each_ref().map(|pair| sum_of_sizes(pair));
    let normal = normal_products.map(|[plus, minus]| plus - minus);
    // A product with the normal is perturbed by its factor and by the products in the normal.
    let scale = |v: &Vector| dot_of_sizes(v, &normal) + dot_of_sizes(v, &normal_sizes);

    let [from_a, from_b, from_c] = vertices.each_ref().map(|vertex| subtract(vertex, origin));
    let edges = [(&from_b, &from_c), (&from_c, &from_a), (&from_a, &from_b)]
        .map(|(p, q)| edge(p, q, direction));
    let farthest = |side| {
        edges.iter().filter(|edge| edge.side == side).map(|edge| edge.margin).reduce(f64::max)
    };
    // The less certain of two edges with different signs determines the margin of being outside.
    let outside = farthest(Ordering::Greater)
        .zip(farthest(Ordering::Less))
        .map(|(positive, negative)| positive.min(negative));

    let slope_terms = products(direction, &normal);
    let slope = sum(&slope_terms);
    if slope.is_zero() {
        let flat = is_zero(&normal);
        let exact = flat || (normal_exact && margin::computed_exactly(&slope_terms));
        let margin = if exact { f64::INFINITY } else { outside.unwrap_or(0.0) };
        return Trace::miss(if flat { "degenerate" } else { "parallel" }, margin);
    }
    let height_terms = products(&from_a, &normal);
    let height = sum(&height_terms);
    let height_margin =
        if height.is_zero() && normal_exact && margin::computed_exactly(&height_terms) {
            f64::INFINITY
        } else {
            margin::of(&height, &scale(&from_a))
        };
    let ahead = sign(&height) == sign(&slope);
    let plane_margin = height_margin.min(margin::of(&slope, &scale(direction)));
    match (outside, ahead) {
        (Some(outside), true) => Trace::miss("outside", outside),
        (Some(outside), false) => Trace::miss("outside", outside.max(plane_margin)),
        (None, false) => Trace::miss("behind", plane_margin),
        (None, true) => {
            let t = height / &slope;
            let cond = condition(&t, &slope, &from_a, direction, &normal, &normal_sizes);
            let margin = edges.iter().map(|edge| edge.margin).fold(plane_margin, f64::min);
            Trace::hit(Surd::rational(t), cond, unit(&normal), margin)
        }
    }
}

/// Returns the side of the ray on which the edge from `p` to `q` passes, seen from the origin: the
/// sign of `d.(p x q)`. The margin of a ray through the edge itself is 0.
fn edge(p: &Vector, q: &Vector, direction: &Vector) -> Edge {
    let normal = cross(p, q);
    let volume = dot(direction, &normal);
    let scale = dot_of_sizes(direction, &normal)
        + dot_of_sizes(p, &cross(q, direction))
        + dot_of_sizes(q, &cross(direction, p));
    let margin = if volume.is_zero() { 0.0 } else { margin::of(&volume, &scale) };
    Edge { side: sign(&volume), margin }
}

/// Returns the relative condition number of `t = height / slope`. It depends on `a - o` and the
/// direction through the normal, and on the edges through the products in the normal and the vector
/// from `a` to the hit point.
fn condition(
    t: &RBig,
    slope: &RBig,
    from_a: &Vector,
    direction: &Vector,
    normal: &Vector,
    normal_sizes: &Vector,
) -> f64 {
    let along: Vector = std::array::from_fn(|i| &from_a[i] - t * &direction[i]);
    let sum = dot_of_sizes(from_a, normal)
        + t * dot_of_sizes(direction, normal)
        + dot_of_sizes(&along, normal_sizes);
    float(&(sum / (t * abs(slope))))
}
