//! How a picture's cost lies in it: what any way of dealing it out has to live with.

use rayweave_contract::{Image, ImageError, Work};
use std::num::NonZeroU32;
use std::time::{Duration, Instant};

/// Passes; of each tile's times the shortest counts, since everything that disturbs makes them
/// longer.
const PASSES: usize = 3;

/// What the tiles of a picture cost, from the top left, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Load {
    costs: Vec<Duration>,
}

impl Load {
    /// Renders `work` on this thread and takes the time of each tile of `tile` pixels a side.
    ///
    /// # Errors
    ///
    /// There is no such picture.
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

    /// Of tiles that cost so much.
    #[must_use]
    pub fn new(costs: Vec<Duration>) -> Self {
        Self { costs }
    }

    /// If each of `threads` threads gets an equal range of the tiles: the cost of the dearest range
    /// over the mean. 1 is even; the speed-up is at most `threads` over it.
    #[must_use]
    pub fn unevenness(&self, threads: usize) -> f64 {
        let (tiles, threads) = (self.costs.len(), threads.max(1));
        let cost = |thread: usize| -> f64 {
            let range = thread * tiles / threads..(thread + 1) * tiles / threads;
            self.costs[range].iter().map(Duration::as_secs_f64).sum()
        };
        let dearest = (0..threads).map(cost).fold(0.0, f64::max);
        dearest * threads as f64 / self.total()
    }

    /// The share of the whole cost that the dearest tile has: the speed-up by tiles is at most 1
    /// over it.
    #[must_use]
    pub fn dearest_tile(&self) -> f64 {
        self.costs.iter().max().map_or(0.0, Duration::as_secs_f64) / self.total()
    }

    /// In seconds, and more than nothing.
    fn total(&self) -> f64 {
        self.costs.iter().sum::<Duration>().as_secs_f64().max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_contract::Tile;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn load(costs: &[u64]) -> Load {
        Load::new(costs.iter().map(|&ms| Duration::from_millis(ms)).collect())
    }

    #[test]
    fn uneven_ranges_and_the_dearest_tile() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let corner = load(&[70, 10, 10, 10]);
        assert!(near(corner.unevenness(2), 1.6) && near(corner.unevenness(1), 1.0));
        assert!(near(corner.unevenness(4), 2.8) && near(corner.dearest_tile(), 0.7));
        // Ranges of 1 and 2 tiles.
        assert!(near(load(&[10, 10, 10]).unevenness(2), 4.0 / 3.0));
        assert!(near(load(&[5, 5]).unevenness(8), 4.0));
        assert!(load(&[0]).unevenness(2) < 1e-9);
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
        let load = Load::of(&work, 5, 3, NonZeroU32::new(2).expect("not 0")).expect("a picture");
        assert_eq!((load.costs.len(), work.0.into_inner()), (6, 6 * PASSES));
    }
}
