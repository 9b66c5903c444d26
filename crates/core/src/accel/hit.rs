//! The closest hit of a ray: its distance and its primitive.

use crate::ray::miss;
use crate::simd::lane::Lane;

/// The closest hit of each ray so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit<L: Lane> {
    /// The hit's `t`, infinite where nothing is hit.
    pub(crate) t: L,
    /// The number of the primitive, where something is hit.
    pub(crate) primitive: L::Index,
}

impl<L: Lane> Hit<L> {
    /// The hit of rays that have not hit anything yet.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { t: miss(), primitive: L::splat_index(0) }
    }

    /// Returns the rays that hit something.
    #[inline(always)]
    pub(crate) fn exists(&self) -> L::Mask {
        self.t.lt(miss())
    }

    /// Takes over another hit where it is closer: its `t` is smaller, or equal with a smaller
    /// number. If hits are offered in the order of their numbers (`ORDERED`), an equal one is never
    /// closer.
    #[inline(always)]
    pub(crate) fn offer<const ORDERED: bool>(&mut self, number: u32, t: L) {
        let mut nearer = t.lt(self.t);
        if !ORDERED {
            let tie = t.equals(self.t) & L::index_above(self.primitive, number);
            nearer = nearer | tie;
        }
        self.t = L::select(nearer, t, self.t);
        self.primitive = L::select_index(nearer, L::splat_index(number), self.primitive);
    }
}
