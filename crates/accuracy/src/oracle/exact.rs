//! Rational numbers and vectors, and numbers with one square root in them.

use std::cmp::Ordering;

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use dashu_ratio::RBig;

use crate::decimal::Decimal;

/// A binary floating-point number of [`BITS`] bits.
type Real = FBig<HalfEven, 2>;
/// Three exact coordinates.
pub(super) type Vector = [RBig; 3];

/// 154 decimal digits: 40 are asked for, and no more than a handful of operations round.
const BITS: usize = 512;

/// The fraction that an f32 is; `None` for one that is not finite.
pub(super) fn number(value: f32) -> Option<RBig> {
    RBig::try_from(value).ok()
}

/// The same for three coordinates.
pub(super) fn vector(value: [f32; 3]) -> Option<Vector> {
    let [x, y, z] = value;
    Some([number(x)?, number(y)?, number(z)?])
}

fn real(value: &RBig) -> Real {
    value.to_float(BITS).value()
}

/// The nearest `f64`: for what needs a few digits only. No product of a few f32 numbers leaves its
/// range.
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

/// The terms of a dot product.
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

/// `sum |a_i b_i|`: what a dot product is as large as, were it not for cancellation.
pub(super) fn dot_of_sizes<const N: usize>(a: &[RBig; N], b: &[RBig; N]) -> RBig {
    sum_of_sizes(&products(a, b))
}

/// The two products whose difference is each component of a cross product.
pub(super) fn cross_products(a: &Vector, b: &Vector) -> [[RBig; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [&a[i] * &b[j], &a[j] * &b[i]])
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    cross_products(a, b).map(|[plus, minus]| plus - minus)
}

/// `p + s sqrt(d)` with rational `p`, `s` and `d >= 0`.
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

    /// `s sqrt(d)`; a `d` below 0 is taken for 0.
    pub(super) fn root(s: RBig, d: RBig) -> Self {
        Self { p: RBig::ZERO, s, d: d.max(RBig::ZERO) }
    }

    pub(super) fn plus(&self, term: &RBig) -> Self {
        Self { p: &self.p + term, ..self.clone() }
    }

    pub(super) fn times(&self, factor: &RBig) -> Self {
        Self { p: &self.p * factor, s: &self.s * factor, d: self.d.clone() }
    }

    /// `p - s sqrt(d)` over the same root.
    fn conjugate(&self) -> Self {
        Self { s: -&self.s, ..self.clone() }
    }

    /// `p^2 - s^2 d`, the number times its conjugate.
    fn norm(&self) -> RBig {
        &self.p * &self.p - &self.s * &self.s * &self.d
    }

    /// The signs of `p` and of `s sqrt(d)`.
    fn signs(&self) -> (Ordering, Ordering) {
        let root = if self.d.is_zero() { Ordering::Equal } else { sign(&self.s) };
        (sign(&self.p), root)
    }

    /// Exact: where the two terms pull in different directions, the larger square wins.
    pub(super) fn sign(&self) -> Ordering {
        match self.signs() {
            (Ordering::Equal, root) => root,
            (rational, Ordering::Equal) => rational,
            (rational, root) if rational == root => rational,
            (Ordering::Greater, _) => sign(&self.norm()),
            (Ordering::Less, _) => sign(&self.norm()).reverse(),
        }
    }

    /// Its value with almost all of [`BITS`] right: no cancellation, as terms of different sign are
    /// turned into the quotient of norm and conjugate.
    fn value(&self) -> Real {
        let plain = |surd: &Self| real(&surd.p) + real(&surd.s) * real(&surd.d).sqrt();
        match self.signs() {
            (Ordering::Equal, _) | (_, Ordering::Equal) => plain(self),
            (rational, root) if rational == root => plain(self),
            _ => real(&self.norm()) / plain(&self.conjugate()),
        }
    }

    /// The nearest `f64` to its value without its sign.
    pub(super) fn size(&self) -> f64 {
        self.value().to_f64().value().abs()
    }

    pub(super) fn decimal(&self) -> Decimal {
        // Only infinite values are no fractions, and none is: no quotient's divisor is 0.
        Decimal::rounded(&RBig::try_from(self.value()).unwrap_or_default())
    }

    /// Whether it is below another number; both without a root in them.
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
