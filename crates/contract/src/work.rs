//! What is computed: a pure function that fills any tile of a picture.

use crate::tile::Tile;

/// A pure function from a pixel's position to its colour, evaluated a tile at a time.
///
/// The contract that every strategy and every proof rests on: a pixel gets the same bits
/// whichever tile it is computed in, on whichever thread, in whichever order, and however often.
/// So a strategy is free in all of these, and a wrapper that watches (who computed what, how far
/// it is, what fails) is a `Work` around a `Work`.
pub trait Work: Sync {
    /// Writes every pixel of `tile`.
    fn render(&self, tile: &mut Tile<'_>);
}

impl<W: Work + ?Sized> Work for &W {
    fn render(&self, tile: &mut Tile<'_>) {
        (**self).render(tile);
    }
}
