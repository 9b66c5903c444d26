//! `rayon-tiles`: a parallel loop over the tiles.
//!
//! * **What it decides**: that a tile is the smallest unit of work. rayon splits the list of tiles
//!   in halves as long as idle threads steal them, never below [`MIN_LEN`].
//! * **What it costs**: a pool that is started once (some 100 us), cutting the image into tiles,
//!   and waiting at the end: a range is split while idle threads ask for it, not once it is being
//!   computed. With all of the cost in one corner the threads that are done wait for that range
//!   (scenes/loads/corner.toml); `with_max_len` would keep ranges small, for a task a tile.
//! * **When it is right**: for moderately uneven work whose pixels share something with their
//!   neighbours, in a program that has rayon already: one line a loop.
//!
//! The pool is its own, with exactly the requested threads: rayon's global pool has as many as the
//! machine has cores, whatever a caller wants to measure.

use rayon::ThreadPool;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Work, render_tile,
};
use std::num::NonZeroU32;

const NAME: &str = "rayon-tiles";

/// The tiles that rayon does not split further: their size is already the parameter.
pub const MIN_LEN: usize = 1;

/// A loop of rayon over tiles, in a pool of its own.
#[derive(Debug)]
pub struct RayonTiles;

impl Strategy for RayonTiles {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "one rayon item a tile, halves of the list stolen by idle threads"
    }

    fn threads(&self) -> Threads {
        Threads::Pool
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::RecursiveSplit,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(TileLoop {
            pool: rayweave_rayon_pool::build(NAME, plan.threads)?,
            tile: plan.tile,
        }))
    }
}

struct TileLoop {
    pool: ThreadPool,
    tile: NonZeroU32,
}

impl Renderer for TileLoop {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let mut tiles = image.tiles(self.tile);
        self.pool.install(|| {
            tiles
                .par_iter_mut()
                .with_min_len(MIN_LEN)
                .try_for_each(|tile| render_tile(NAME, work, tile))
        })
    }
}
