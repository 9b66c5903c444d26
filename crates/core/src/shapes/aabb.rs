//! The axis-aligned box around a primitive.

use crate::simd::lane::Scalar;
use crate::simd::vector::Vector;

/// The box around a primitive: the lower x, y and z, the upper ones, and two numbers that make it
/// eight, for an index without a bounds check.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb<S>([S; 8]);

impl<S: Scalar> Aabb<S> {
    pub(crate) fn new(low: Vector<S>, high: Vector<S>) -> Self {
        let zero = S::literal(0.0);
        Self([low.x, low.y, low.z, high.x, high.y, high.z, zero, zero])
    }

    pub(crate) fn low(&self) -> Vector<S> {
        Vector::new(self.0[0], self.0[1], self.0[2])
    }

    pub(crate) fn high(&self) -> Vector<S> {
        Vector::new(self.0[3], self.0[4], self.0[5])
    }

    /// Returns the coordinate of a side. The lower x, y and z have the numbers 0, 1 and 2, the
    /// upper ones 3, 4 and 5.
    #[inline(always)]
    pub(crate) fn side(&self, number: usize) -> S {
        // The remainder needs no bounds check.
        self.0[number % 8]
    }

    /// Returns the box around both.
    pub(crate) fn join(self, other: Self) -> Self {
        Self::new(self.low().min(other.low()), self.high().max(other.high()))
    }

    /// Returns the largest magnitude of a coordinate.
    pub(crate) fn reach(&self) -> S {
        let Vector { x, y, z } = self.low().abs().max(self.high().abs());
        x.max(y).max(z)
    }
}
