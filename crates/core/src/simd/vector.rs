//! Vectors of three numbers, each of them a [`Lane`].

use crate::simd::lane::{Lane, Scalar, product_error, sum_error};
use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

/// A point, a direction or a colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) z: L,
}

impl<L: Lane> Vector<L> {
    #[inline(always)]
    pub(crate) fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    /// Returns the same vector in every lane.
    #[inline(always)]
    pub(crate) fn splat(v: Vector<L::Scalar>) -> Self {
        Self::new(L::splat(v.x), L::splat(v.y), L::splat(v.z))
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [L; 3] {
        [self.x, self.y, self.z]
    }

    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self::new(L::literal(0.0), L::literal(0.0), L::literal(0.0))
    }

    /// Returns the dot product, summed from x to z: an order that no lane or compiler may change.
    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Returns the dot product as if computed in twice the digits and then rounded, barring
    /// underflow: Dot2 of Ogita, Rump and Oishi (Accurate Sum and Dot Product, 2005). Returns the
    /// plain dot product if an intermediate number overflows.
    #[inline(always)]
    pub(crate) fn accurate_dot(self, other: Self) -> L {
        let product = |a: L, b: L| (a * b, product_error(a, b, a * b));
        let ((x, x_error), (y, y_error), (z, z_error)) =
            (product(self.x, other.x), product(self.y, other.y), product(self.z, other.z));
        let xy = x + y;
        let sum = xy + z;
        let error = (sum_error(x, y, xy) + sum_error(xy, z, sum)) + (x_error + y_error + z_error);
        L::select(error.abs().lt(L::literal(f64::INFINITY)), sum + error, sum)
    }

    /// Returns the cross product.
    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Returns the smaller of each component.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        Self::new(self.x.min(other.x), self.y.min(other.y), self.z.min(other.z))
    }

    /// Returns the larger of each component.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        Self::new(self.x.max(other.x), self.y.max(other.y), self.z.max(other.z))
    }

    /// Multiplies each component.
    #[inline(always)]
    pub(crate) fn scale(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    /// Returns the magnitude of each component.
    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// Returns the sum of the magnitudes of the components.
    #[inline(always)]
    pub(crate) fn sum_of_magnitudes(self) -> L {
        self.x.abs() + self.y.abs() + self.z.abs()
    }

    /// Returns the vector at unit length.
    #[inline(always)]
    pub(crate) fn unit(self) -> Self {
        self * (L::literal(1.0) / self.dot(self).sqrt())
    }

    /// Returns `yes` where the mask is true, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            L::select(mask, yes.x, no.x),
            L::select(mask, yes.y, no.y),
            L::select(mask, yes.z, no.z),
        )
    }
}

impl<S: Scalar> Vector<S> {
    /// Rounds each component.
    pub(crate) fn rounded(v: DVec3) -> Self {
        Self::new(S::from_f64(v.x), S::from_f64(v.y), S::from_f64(v.z))
    }

    /// Returns the same vector in `f64`.
    pub(crate) fn widened(self) -> DVec3 {
        DVec3::new(self.x.to_f64(), self.y.to_f64(), self.z.to_f64())
    }
}

impl<L: Lane> Add for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: Lane> Sub for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: Lane> Mul<L> for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<L: Lane> Neg for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches an error term that is dropped, doubled or of the wrong sign: sums that cancel keep
    /// all digits.
    #[test]
    fn accurate_dot_keeps_the_digits_of_sums_that_cancel() {
        let u = 2f64.powi(-24);
        let mut cancelled = 0;
        for i in 1..400_i16 {
            let k = f32::from(i);
            let (a, b) = (
                Vector::new(1.0 + k / 7.0, -k / 3.0, 1.7),
                Vector::new(k / 11.0, 2.0 + k / 13.0, 0.9),
            );
            // The last term cancels the first two, up to a rounding.
            let a = Vector { z: -(a.x * b.x + a.y * b.y) / b.z, ..a };
            for (a, b) in [(a, b), (b, a), (Vector::new(a.z, a.x, a.y), Vector::new(b.z, b.x, b.y))]
            {
                let (wide_a, wide_b) = (a.widened(), b.widened());
                let (exact, terms) = (wide_a.dot(wide_b), wide_a.abs().dot(wide_b.abs()));
                let error = (f64::from(a.accurate_dot(b)) - exact).abs();
                assert!(error <= u * exact.abs() + 16.0 * u * u * terms, "{error:e} of {exact:e}");
                cancelled += usize::from(exact.abs() < 1e-6 * terms);
            }
        }
        assert!(cancelled > 500, "only {cancelled} sums cancel");
    }

    /// Catches a guard that lets a NaN pass where the error's halves overflow.
    #[test]
    fn accurate_dot_of_huge_numbers_is_the_plain_one() {
        let (a, b) = (Vector::new(1e38_f32, 1.0, 1.0), Vector::new(1.0, 2.0, 3.0));
        assert_eq!(a.accurate_dot(b), a.dot(b));
    }
}
