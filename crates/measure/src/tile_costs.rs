//! The cost of each tile of an image, and the bounds that it sets to any scheduling.

use rayweave_contract::{Image, ImageError, Work};
use std::num::NonZeroU32;
use std::time::{Duration, Instant};

/// The number of passes. The shortest time of each tile is used, because interference only adds
/// time.
const PASSES: usize = 3;

/// The costs of the tiles of an image, from the top left, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TileCosts {
    costs: Vec<Duration>,
}

impl TileCosts {
    /// Renders `work` on this thread and times each tile of `tile` pixels a side.
    ///
    /// # Errors
    ///
    /// There is no image of this size.
    pub fn of(
        work: &dyn Work,
        width: u32,
        height: u32,
        tile: NonZeroU32,
    ) -> Result<Self, ImageError> {
        let mut image = Image::new(width, height)?;
        let mut pass = || -> Vec<Duration> {
            let time = |tile: &mut rayweave_contract::Tile<'_>| {
                let begin = Instant::now();
                work.render(tile);
                begin.elapsed()
            };
            image.tiles(tile).iter_mut().map(time).collect()
        };
        let mut costs = pass();
        for _ in 1..PASSES {
            costs.iter_mut().zip(pass()).for_each(|(cost, again)| *cost = again.min(*cost));
        }
        Ok(Self { costs })
    }

    /// Returns the costs of tiles that took these times.
    #[must_use]
    pub fn new(costs: Vec<Duration>) -> Self {
        Self { costs }
    }

    /// Returns the imbalance of `threads` equal ranges of tiles: the largest cost of a range over
    /// their mean. 1 is even; the speed-up is at most `threads` divided by it.
    #[must_use]
    pub fn imbalance(&self, threads: usize) -> f64 {
        let (tiles, threads) = (self.costs.len(), threads.max(1));
        let cost = |thread: usize| -> f64 {
            let range = thread * tiles / threads..(thread + 1) * tiles / threads;
            self.costs[range].iter().map(Duration::as_secs_f64).sum()
        };
        let max = (0..threads).map(cost).fold(0.0, f64::max);
        max * threads as f64 / self.total()
    }

    /// Returns the share of the total cost that the most expensive tile has. The speed-up by whole
    /// tiles is at most 1 divided by it.
    #[must_use]
    pub fn max_share(&self) -> f64 {
        self.costs.iter().max().map_or(0.0, Duration::as_secs_f64) / self.total()
    }

    /// Returns the total in seconds, which is more than 0.
    fn total(&self) -> f64 {
        self.costs.iter().sum::<Duration>().as_secs_f64().max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_contract::Tile;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn costs(costs: &[u64]) -> TileCosts {
        TileCosts::new(costs.iter().map(|&ms| Duration::from_millis(ms)).collect())
    }

    #[test]
    fn imbalance_of_ranges_and_the_largest_share() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let corner = costs(&[70, 10, 10, 10]);
        assert!(near(corner.imbalance(2), 1.6) && near(corner.imbalance(1), 1.0));
        assert!(near(corner.imbalance(4), 2.8) && near(corner.max_share(), 0.7));
        // Ranges of 1 and 2 tiles.
        assert!(near(costs(&[10, 10, 10]).imbalance(2), 4.0 / 3.0));
        assert!(near(costs(&[5, 5]).imbalance(8), 4.0));
        assert!(costs(&[0]).imbalance(2) < 1e-9);
    }

    /// Catches a tile that is left out, or rendered once only.
    #[test]
    fn every_tile_is_timed_in_each_pass() {
        struct Counts(AtomicUsize);

        impl Work for Counts {
            fn render(&self, _: &mut Tile<'_>) {
                self.0.fetch_add(1, Ordering::Relaxed);
            }
        }

        let work = Counts(AtomicUsize::new(0));
        let timed =
            TileCosts::of(&work, 5, 3, NonZeroU32::new(2).expect("not 0")).expect("an image");
        assert_eq!((timed.costs.len(), work.0.into_inner()), (6, 6 * PASSES));
    }
}
