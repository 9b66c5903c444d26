//! Vectors of three numbers, each of them a [`Lane`].

use crate::lane::{Lane, Scalar, product_error, sum_error};
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

    #[inline(always)]
    pub(crate) fn splat(v: Vector<L::Scalar>) -> Self {
        Self::new(L::splat(v.x), L::splat(v.y), L::splat(v.z))
    }

    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self::new(L::literal(0.0), L::literal(0.0), L::literal(0.0))
    }

    /// The sum is taken from x to z: an order that no lane or compiler may change.
    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The dot product as if computed in twice the digits and then rounded: Dot2 of Ogita, Rump and Oishi
    /// (Accurate Sum and Dot Product, 2005). Where its intermediate numbers overflow, the plain one.
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

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Component by component.
    #[inline(always)]
    pub(crate) fn scale(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    #[inline(always)]
    pub(crate) fn sum_of_magnitudes(self) -> L {
        self.x.abs() + self.y.abs() + self.z.abs()
    }

    #[inline(always)]
    pub(crate) fn unit(self) -> Self {
        self * (L::literal(1.0) / self.dot(self).sqrt())
    }

    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(L::select(mask, yes.x, no.x), L::select(mask, yes.y, no.y), L::select(mask, yes.z, no.z))
    }
}

impl<S: Scalar> Vector<S> {
    /// Each component rounded.
    pub(crate) fn rounded(v: DVec3) -> Self {
        Self::new(S::from_f64(v.x), S::from_f64(v.y), S::from_f64(v.z))
    }

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
