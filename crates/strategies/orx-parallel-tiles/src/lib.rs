//! `orx-parallel-tiles`: a loop over the tiles with `orx-parallel`, whose threads pull from one iterator.
//!
//! * **What it decides**: nothing beforehand. The iterator over the tiles is one that threads may share:
//!   whoever is free takes the next tile from it.
//! * **What it costs**: cutting the picture into tiles, an atomic addition a tile, starting the threads
//!   within every rendering, and at the end up to one tile's time of waiting.
//! * **When it is right**: where a loop is a chain of iterators and should stay one, and all threads of
//!   the machine are meant. It has the balance of `tile-queue` without a queue.
//!
//! Its own pools have as many threads as the machine has cores at the most, whatever is asked for. So it
//! is given a pool of scoped threads that has exactly N; one that cannot be started would be a panic, so
//! as many are tried out before.

use orx_parallel::{Par, ParCollectionMut, Runner, ThreadPool};
use rayweave_core::strategy::{Dealing, Delivery, Piece, Rule};
use rayweave_core::{Image, Plan, Renderer, Strategy, StrategyError, ThreadsStart, Work};
use rayweave_thread_team::{self as thread_team, Team};
use std::num::NonZeroUsize;
use std::thread;

const NAME: &str = "orx-parallel-tiles";

/// A loop of orx-parallel over tiles, on scoped threads.
#[derive(Debug)]
pub struct OrxParallelTiles;

impl Strategy for OrxParallelTiles {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "orx-parallel: threads take the next tile from one iterator"
    }

    fn threads_start(&self) -> ThreadsStart {
        ThreadsStart::Render
    }

    fn rule(&self) -> Rule {
        Rule { piece: Piece::Tile, dealing: Dealing::Shared { chunk: 1 }, delivery: Delivery::InPlace }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        thread_team::try_out(NAME, plan.threads)?;
        Ok(Box::new(TileLoop { plan }))
    }
}

struct TileLoop {
    plan: Plan,
}

impl Renderer for TileLoop {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let mut tiles = image.tiles(self.plan.tile);
        let team = Team::new(NAME);
        let threads = self.plan.threads;
        let tiles = tiles.par_mut().runner(Runner::fixed_with_pool(ScopedThreads(threads)));
        tiles.num_threads(threads.get()).chunk_size(1).for_each(|tile| {
            // After a failure the rest of the iterations return at once.
            let _ = team.render_tile(work, tile);
        });
        team.outcome()
    }
}

/// As many threads, started for each loop.
struct ScopedThreads(NonZeroUsize);

impl ThreadPool for ScopedThreads {
    type ScopeRef<'s, 'env, 'scope>
        = &'s thread::Scope<'s, 'env>
    where
        'scope: 's,
        'env: 'scope + 's;

    fn max_num_threads(&self) -> NonZeroUsize {
        self.0
    }

    fn scope<'env, 'scope, F>(&'env self, spawn: F)
    where
        'env: 'scope,
        for<'s> F: FnOnce(&'s thread::Scope<'s, 'env>) + Send,
    {
        thread::scope(spawn);
    }
}
