//! A work and strategies for the tests of this crate.

use rayweave_contract::{
    Granularity, Output, Policy, RenderError, RenderFn, Rgb, Scheduling, Strategy, Threads, Tile,
    Work, renderer,
};
use std::num::NonZeroU32;

/// The colour that [`Grey`] gives to every pixel.
pub(crate) const GREY: Rgb = [0.5; 3];

/// The side of the tiles of a fake strategy, whatever the plan says.
pub(crate) const SIDE: NonZeroU32 = NonZeroU32::new(2).expect("2 is not 0");

/// A work that only fills.
pub(crate) struct Grey;

impl Work for Grey {
    fn render(&self, tile: &mut Tile<'_>) {
        tile.rows().for_each(|(_, row)| row.fill(GREY));
    }
}

/// Renders on the caller's thread, but for the first `left_out` tiles.
pub(crate) fn skip(left_out: usize) -> Result<RenderFn, RenderError> {
    renderer(move |work, image| {
        image.tiles(SIDE).iter_mut().skip(left_out).for_each(|tile| work.render(tile));
        Ok(())
    })
}

/// Returns a strategy that renders every tile.
pub(crate) const fn complete(name: &'static str, threads: Threads) -> Strategy<'static> {
    Strategy {
        name,
        summary: "a fake",
        threads,
        policy: Policy::new(Granularity::Tile, Scheduling::Dynamic { chunk: 1 }, Output::InPlace),
        unavailable: None,
        prepare: &|_| skip(0),
    }
}

/// Returns a strategy that must not be prepared, because the executor is a fake.
pub(crate) const fn named(name: &'static str, threads: Threads) -> Strategy<'static> {
    Strategy { prepare: &|_| unreachable!("the executor is a fake"), ..complete(name, threads) }
}
