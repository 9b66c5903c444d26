//! Distances to a decision boundary, in ulps.

use dashu_ratio::RBig;

use super::exact::{abs, float, sum, sum_of_sizes};

/// An f32 has 24 bits.
const F32_BITS: usize = 24;
/// One ulp of a number in `1..2`.
const ULP: f64 = 1.0 / (1_u32 << (F32_BITS - 1)) as f64;

/// How many ulps of `scale` the `distance` is; infinite where nothing can be perturbed.
pub(super) fn in_ulps(distance: f64, scale: f64) -> f64 {
    if scale == 0.0 { f64::INFINITY } else { distance.abs() / scale / ULP }
}

/// The margin of the sign of a fraction that is perturbed by `scale` times the perturbation of its
/// inputs.
pub(super) fn of(value: &RBig, scale: &RBig) -> f64 {
    in_ulps(float(value), float(scale))
}

/// The margin of the sign of a sum of products; infinite for a 0 that f32 computes as such.
pub(super) fn of_sum(terms: &[RBig]) -> f64 {
    let value = sum(terms);
    if value.is_zero() && computed_exactly(terms) {
        f64::INFINITY
    } else {
        of(&value, &sum_of_sizes(terms))
    }
}

/// Whether f32 arithmetic adds these fractions without rounding, in any order: all are multiples of
/// one power of two, and their sizes add up to no more than 2^24 of it.
pub(super) fn computed_exactly(terms: &[RBig]) -> bool {
    let units = terms.iter().filter(|term| !term.is_zero()).map(lowest_bit);
    match units.min() {
        Some(unit) => sum_of_sizes(terms) <= unit * RBig::from(1_u32 << F32_BITS),
        None => true,
    }
}

/// The power of two that the lowest bit of a binary fraction other than 0 stands for.
fn lowest_bit(value: &RBig) -> RBig {
    let zeros = value.numerator().trailing_zeros().unwrap_or(0);
    let odd = value.numerator() >> zeros;
    abs(&(value / RBig::from(odd)))
}
