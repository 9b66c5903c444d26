//! The work: a pure function that fills any tile of an image.

use crate::tile::Tile;

/// A pure function from a pixel's position to its colour, evaluated a tile at a time.
///
/// Every strategy and every proof relies on this: a pixel gets the same bits in any tile, on any
/// thread, in any order, and however often it is computed. So a strategy is free in all of these,
/// and an observer (a recorder, a progress bar, fault injection) is a `Work` around a `Work`.
///
/// ```
/// use rayweave_contract::{Tile, Work};
/// use std::sync::atomic::{AtomicU32, Ordering};
///
/// /// Counts the tiles that another work renders.
/// struct Counted<W>(W, AtomicU32);
///
/// impl<W: Work> Work for Counted<W> {
///     fn render(&self, tile: &mut Tile<'_>) {
///         self.1.fetch_add(1, Ordering::Relaxed);
///         self.0.render(tile);
///     }
/// }
/// ```
pub trait Work: Sync {
    /// Writes every pixel of `tile`.
    fn render(&self, tile: &mut Tile<'_>);
}

impl<W: Work + ?Sized> Work for &W {
    fn render(&self, tile: &mut Tile<'_>) {
        (**self).render(tile);
    }
}
