//! Margins: the distance of a computed sign from its decision boundary, in ulps.

use dashu_ratio::RBig;

use super::exact::{abs, float, sum, sum_of_sizes};

/// The number of significant bits of an f32.
const F32_BITS: usize = 24;
/// One ulp of a number in `1..2`.
const ULP: f64 = 1.0 / (1_u32 << (F32_BITS - 1)) as f64;

/// Returns `distance` in ulps of `scale`; infinite where nothing can be perturbed.
pub(super) fn in_ulps(distance: f64, scale: f64) -> f64 {
    if scale == 0.0 { f64::INFINITY } else { distance.abs() / scale / ULP }
}

/// Returns the margin of the sign of a fraction that is perturbed by `scale` times the perturbation
/// of its inputs.
pub(super) fn of(value: &RBig, scale: &RBig) -> f64 {
    in_ulps(float(value), float(scale))
}

/// Returns the margin of the sign of a sum of products; infinite for a 0 that f32 computes exactly.
pub(super) fn of_sum(terms: &[RBig]) -> f64 {
    let value = sum(terms);
    if value.is_zero() && computed_exactly(terms) {
        f64::INFINITY
    } else {
        of(&value, &sum_of_sizes(terms))
    }
}

/// Returns whether f32 arithmetic adds these fractions without rounding, in any order. It does if
/// all are multiples of one power of two and their sizes add up to no more than 2^24 of it.
pub(super) fn computed_exactly(terms: &[RBig]) -> bool {
    let units = terms.iter().filter(|term| !term.is_zero()).map(lowest_bit);
    match units.min() {
        Some(unit) => sum_of_sizes(terms) <= unit * RBig::from(1_u32 << F32_BITS),
        None => true,
    }
}

/// Returns the power of two of the lowest bit of a binary fraction other than 0.
fn lowest_bit(value: &RBig) -> RBig {
    let zeros = value.numerator().trailing_zeros().unwrap_or(0);
    let odd = value.numerator() >> zeros;
    abs(&(value / RBig::from(odd)))
}
