//! Lesson 10, `rayon-tiles`: a parallel loop over the tiles.
//!
//! In OpenMP: `#pragma omp taskloop` over the tiles comes nearest.
//!
//! * **New**: a limit of rayon's splitting. A range is halved until there are about twice as many
//!   parts as threads. A stolen part is halved again; a part that nobody steals is not. With all of
//!   the cost in one corner, the threads that are done wait for the one that computes that part
//!   (`scenes/loads/corner.toml`). `with_max_len(1)` would make every tile a part of its own.
//! * **What it decides**: that a tile is the smallest piece of work.
//! * **What it costs**: cutting the image into tiles, and waiting for a part that was not halved.
//! * **When it is right**: for moderately uneven work whose pixels share something with their
//!   neighbours, in a program that has rayon already.

use rayon::prelude::*;
use rayweave_contract::*;

/// A loop of rayon over tiles.
pub static STRATEGY: Strategy = Strategy {
    name: "rayon-tiles",
    summary: "rayon's loop over the tiles: idle threads steal halves",
    threads: Threads::Pool,
    policy: Policy::new(Granularity::Tile, Scheduling::RecursiveSplit, Output::InPlace),
    unavailable: None,
    prepare: &|plan| {
        let pool = rayweave_rayon_pool::build(plan.threads)?;
        renderer(move |work, image| {
            let mut tiles = image.tiles(plan.tile);
            pool.install(|| tiles.par_iter_mut().try_for_each(|tile| render_tile(work, tile)))
        })
    },
};
