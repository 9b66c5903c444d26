//! Lesson 12, `paralight-tiles`: a parallel loop over the tiles by a library for slices alone.
//!
//! In OpenMP: LLVM's `schedule(nonmonotonic: dynamic)` also steals from ranges, a quarter of the
//! rest at a time.
//!
//! * **New**: work stealing without deques. A thread's share is a range, two numbers in one atomic;
//!   a thread that is done takes half of another's rest by one compare-and-swap.
//! * **What it decides**: a first share for each thread, an equal range of the tiles.
//! * **What it costs**: cutting the image into tiles, and an atomic operation for every tile. A
//!   loop begins and ends sooner than rayon's, but loops do not nest.
//! * **When it is right**: for flat loops over slices that are short or come often, where the start
//!   of rayon's loop shows. The library is young: below version 0.1.

use paralight::prelude::*;
use rayweave_contract::*;

/// A loop of paralight over tiles.
pub static STRATEGY: Strategy = Strategy {
    name: "paralight-tiles",
    summary: "paralight's loop over the tiles: idle threads steal halves",
    threads: Threads::Pool,
    policy: Policy::new(Granularity::Tile, Scheduling::WorkStealing, Output::InPlace),
    unavailable: None,
    prepare: &|plan| {
        // The pool panics where a thread cannot be started.
        rayweave_thread_team::probe(plan.threads)?;
        let pool = ThreadPoolBuilder {
            num_threads: ThreadCount::Count(plan.threads),
            range_strategy: RangeStrategy::WorkStealing,
            cpu_pinning: CpuPinningPolicy::No,
        };
        let mut pool = pool.build();
        renderer(move |work, image| {
            let mut tiles = image.tiles(plan.tile);
            let tiles = tiles.par_iter_mut().with_thread_pool(&mut pool);
            tiles.try_for_each(|tile| render_tile(work, tile))
        })
    },
};
