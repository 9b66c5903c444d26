//! `paralight-tiles`: a loop over the tiles with `paralight`, a library for slices and nothing
//! else.
//!
//! * **What it decides**: a first share for each thread, an equal range of the tiles. A thread that
//!   is done takes half of what another has left, by one compare-and-swap of the two ends of its
//!   range.
//! * **What it costs**: a pool that is started once, cutting the image into tiles, and an atomic
//!   operation a tile. There are no tasks and no deques, so a loop begins and ends sooner than
//!   rayon's; in return loops do not nest.
//! * **When it is right**: for flat loops over slices that are short or come often, where rayon's
//!   start of a loop shows. It is young: below version 0.1.
//!
//! Its pool panics if a thread cannot be started, so `prepare` probes the threads first.

use paralight::prelude::*;
use paralight::threads::ThreadPool;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Work, render_tile,
};
use rayweave_thread_team as thread_team;
use std::num::NonZeroU32;

const NAME: &str = "paralight-tiles";

/// A loop of paralight over tiles, in a pool of its own.
#[derive(Debug)]
pub struct ParalightTiles;

impl Strategy for ParalightTiles {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "paralight: an equal range of the tiles a thread; an idle thread takes half of another's"
    }

    fn threads(&self) -> Threads {
        Threads::Pool
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::WorkStealing,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        thread_team::probe(NAME, plan.threads)?;
        let pool = ThreadPoolBuilder {
            num_threads: ThreadCount::Count(plan.threads),
            range_strategy: RangeStrategy::WorkStealing,
            cpu_pinning: CpuPinningPolicy::No,
        };
        Ok(Box::new(TileLoop { pool: pool.build(), tile: plan.tile }))
    }
}

struct TileLoop {
    pool: ThreadPool,
    tile: NonZeroU32,
}

impl Renderer for TileLoop {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let mut tiles = image.tiles(self.tile);
        let tiles = tiles.par_iter_mut().with_thread_pool(&mut self.pool);
        tiles.try_for_each(|tile| render_tile(NAME, work, tile))
    }
}
