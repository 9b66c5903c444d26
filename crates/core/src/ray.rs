//! A ray, and what every shape asks of it.

use crate::lane::Lane;
use crate::vector::Vector;

/// The half line `origin + t direction` for `t > 0`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray<L> {
    pub(crate) origin: Vector<L>,
    /// Of any length: `t` counts in it.
    pub(crate) direction: Vector<L>,
}

impl<L: Lane> Ray<L> {
    #[inline(always)]
    pub(crate) fn at(&self, t: L) -> Vector<L> {
        self.origin + self.direction * t
    }
}

/// The `t` that stands for "no hit".
#[inline(always)]
pub(crate) fn miss<L: Lane>() -> L {
    L::literal(f64::INFINITY)
}
