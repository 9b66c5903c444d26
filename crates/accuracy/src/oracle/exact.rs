//! Exact arithmetic: rational numbers and vectors, and numbers with one square root.

use std::cmp::Ordering;

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use dashu_ratio::RBig;

use crate::decimal::Decimal;

/// A binary floating-point number of [`BITS`] bits.
type Real = FBig<HalfEven, 2>;
/// Three exact coordinates.
pub(super) type Vector = [RBig; 3];

/// The precision in bits: 154 decimal digits, for 40 digits after a few rounded operations.
const BITS: usize = 512;

/// Returns the exact value of an f32; `None` if it is not finite.
pub(super) fn number(value: f32) -> Option<RBig> {
    RBig::try_from(value).ok()
}

/// Returns the exact value of three coordinates; `None` if one is not finite.
pub(super) fn vector(value: [f32; 3]) -> Option<Vector> {
    let [x, y, z] = value;
    Some([number(x)?, number(y)?, number(z)?])
}

fn real(value: &RBig) -> Real {
    value.to_float(BITS).value()
}

/// Returns the nearest `f64`, for uses that need a few digits only. No product of a few f32 numbers
/// leaves its range.
pub(super) fn float(value: &RBig) -> f64 {
    value.to_f64().value()
}

pub(super) fn sign(value: &RBig) -> Ordering {
    value.cmp(&RBig::ZERO)
}

pub(super) fn abs(value: &RBig) -> RBig {
    if *value < RBig::ZERO { -value } else { value.clone() }
}

pub(super) fn is_zero(vector: &Vector) -> bool {
    vector.iter().all(RBig::is_zero)
}

pub(super) fn subtract(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| &a[i] - &b[i])
}

/// Returns the terms of a dot product.
pub(super) fn products<const N: usize>(a: &[RBig; N], b: &[RBig; N]) -> [RBig; N] {
    std::array::from_fn(|i| &a[i] * &b[i])
}

pub(super) fn sum(terms: &[RBig]) -> RBig {
    terms.iter().fold(RBig::ZERO, |sum, term| sum + term)
}

pub(super) fn sum_of_sizes(terms: &[RBig]) -> RBig {
    terms.iter().fold(RBig::ZERO, |sum, term| sum + abs(term))
}

pub(super) fn dot<const N: usize>(a: &[RBig; N], b: &[RBig; N]) -> RBig {
    sum(&products(a, b))
}

/// Returns `sum |a_i b_i|`, the size of a dot product without cancellation.
pub(super) fn dot_of_sizes<const N: usize>(a: &[RBig; N], b: &[RBig; N]) -> RBig {
    sum_of_sizes(&products(a, b))
}

/// Returns, for each component of a cross product, the two products whose difference it is.
pub(super) fn cross_products(a: &Vector, b: &Vector) -> [[RBig; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [&a[i] * &b[j], &a[j] * &b[i]])
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    cross_products(a, b).map(|[plus, minus]| plus - minus)
}

/// The number `p + s sqrt(d)` with rational `p`, `s` and `d >= 0`.
#[derive(Clone, Debug)]
pub(super) struct Surd {
    p: RBig,
    s: RBig,
    d: RBig,
}

impl Surd {
    pub(super) fn rational(p: RBig) -> Self {
        Self { p, s: RBig::ZERO, d: RBig::ZERO }
    }

    /// Creates `s sqrt(d)`; a `d` below 0 counts as 0.
    pub(super) fn root(s: RBig, d: RBig) -> Self {
        Self { p: RBig::ZERO, s, d: d.max(RBig::ZERO) }
    }

    pub(super) fn plus(&self, term: &RBig) -> Self {
        Self { p: &self.p + term, ..self.clone() }
    }

    pub(super) fn times(&self, factor: &RBig) -> Self {
        Self { p: &self.p * factor, s: &self.s * factor, d: self.d.clone() }
    }

    /// Returns `p - s sqrt(d)`.
    fn conjugate(&self) -> Self {
        Self { s: -&self.s, ..self.clone() }
    }

    /// Returns `p^2 - s^2 d`, the product of the number and its conjugate.
    fn norm(&self) -> RBig {
        &self.p * &self.p - &self.s * &self.s * &self.d
    }

    /// Returns the signs of `p` and of `s sqrt(d)`.
    fn signs(&self) -> (Ordering, Ordering) {
        let root = if self.d.is_zero() { Ordering::Equal } else { sign(&self.s) };
        (sign(&self.p), root)
    }

    /// Returns the exact sign. Where the two terms differ in sign, the larger square decides.
    pub(super) fn sign(&self) -> Ordering {
        match self.signs() {
            (Ordering::Equal, root) => root,
            (rational, Ordering::Equal) => rational,
            (rational, root) if rational == root => rational,
            (Ordering::Greater, _) => sign(&self.norm()),
            (Ordering::Less, _) => sign(&self.norm()).reverse(),
        }
    }

    /// Returns the value with almost all of [`BITS`] correct. Nothing cancels, because terms of
    /// different sign are turned into the quotient of norm and conjugate.
    fn value(&self) -> Real {
        let plain = |surd: &Self| real(&surd.p) + real(&surd.s) * real(&surd.d).sqrt();
        match self.signs() {
            (Ordering::Equal, _) | (_, Ordering::Equal) => plain(self),
            (rational, root) if rational == root => plain(self),
            _ => real(&self.norm()) / plain(&self.conjugate()),
        }
    }

    /// Returns the nearest `f64` to the absolute value.
    pub(super) fn size(&self) -> f64 {
        self.value().to_f64().value().abs()
    }

    pub(super) fn decimal(&self) -> Decimal {
        // Only infinite values are not fractions. None occurs, because no divisor is 0.
        Decimal::rounded(&RBig::try_from(self.value()).unwrap_or_default())
    }

    /// Returns whether the number is less than another; both must be rational.
    pub(super) fn is_less_rational(&self, other: &Self) -> bool {
        self.p < other.p
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surd(p: i32, s: i32, d: i32) -> Surd {
        Surd { p: p.into(), s: s.into(), d: d.into() }
    }

    #[test]
    fn signs_are_exact_where_floats_fail() {
        // 665857^2 = 2 * 470832^2 + 1: the quotient is sqrt(2) to 12 digits.
        assert_eq!(surd(665_857, -470_832, 2).sign(), Ordering::Greater);
        assert_eq!(surd(-665_857, 470_832, 2).sign(), Ordering::Less);
        assert_eq!(surd(6, -3, 4).sign(), Ordering::Equal);
        assert_eq!(surd(0, -1, 3).sign(), Ordering::Less);
        assert_eq!(surd(-1, 5, 0).sign(), Ordering::Less);
        assert_eq!(surd(2, 1, 7).sign(), Ordering::Greater);
    }

    #[test]
    fn values_keep_their_digits_under_cancellation() {
        // The norm is 1, so that the number is 1 / (665857 + 470832 sqrt(2)).
        let digits = "7.509119826032946028994342708842515725208e-7";
        assert_eq!(surd(665_857, -470_832, 2).decimal().to_string(), digits);
        assert_eq!(surd(0, 1, 2).decimal().to_string(), "1.41421356237309504880168872420969807857");
        assert_eq!(surd(6, -3, 4).decimal().to_f64(), 0.0);
        assert_eq!(surd(-3, 1, 4).size(), 1.0);
    }
}
