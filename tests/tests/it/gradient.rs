//! A work to try strategies with, and its plans.

use rayweave_contract::{Rgb, Tile, Work};
use std::num::{NonZeroU32, NonZeroUsize};
use std::panic::resume_unwind;
use std::time::Duration;

/// An image in which no two pixels are alike.
pub(crate) struct Gradient;

impl Gradient {
    pub(crate) fn color(x: u32, y: u32) -> Rgb {
        [x as f32 + 0.25, y as f32 - 0.5, (x * 31 + y) as f32 / 7.0]
    }
}

impl Work for Gradient {
    fn render(&self, tile: &mut Tile<'_>) {
        let left = tile.rect().x;
        for (y, row) in tile.rows() {
            (left..).zip(row).for_each(|(x, color)| *color = Self::color(x, y));
        }
    }
}

/// A work that panics at one pixel.
pub(crate) struct Panics<W> {
    pub(crate) work: W,
    pub(crate) x: u32,
    pub(crate) y: u32,
}

impl<W: Work> Work for Panics<W> {
    fn render(&self, tile: &mut Tile<'_>) {
        if tile.rect().contains(self.x, self.y) {
            // A panic, without the message on standard error that `panic!` writes.
            resume_unwind(Box::new("injected"));
        }
        self.work.render(tile);
    }
}

/// A timeout for a busy machine. A strategy that has its threads never waits so long.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

pub(crate) fn threads(count: usize) -> NonZeroUsize {
    NonZeroUsize::new(count).expect("not 0")
}

pub(crate) fn tile(side: u32) -> NonZeroU32 {
    NonZeroU32::new(side).expect("not 0")
}
