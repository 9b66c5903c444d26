//! `tile-queue`: threads take the next tile from a lock-free queue and write its rows directly.
//!
//! * **What it decides**: nothing beforehand. All tiles are in one `crossbeam` queue; a thread that
//!   is done with a tile takes the next, so the load balances itself down to the size of a tile.
//! * **What it costs**: cutting the image into tiles, one pop (some 4 ns) a tile, starting the
//!   threads within every rendering, and at the end up to one tile's time of waiting.
//! * **When it is right**: for uneven work whose cost is not known beforehand. The size of a tile
//!   is the parameter: small enough that the last one does not matter, large enough that work can
//!   be shared inside it.
//!
//! A tile brings the slices of the rows it covers, and no two tiles cover the same pixel. So rows
//! are written without a lock, and the compiler has proved that they may be.

use crossbeam::queue::ArrayQueue;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Work,
};
use rayweave_thread_team as thread_team;
use std::iter;

const NAME: &str = "tile-queue";

/// Threads that pop tiles from a queue.
#[derive(Debug)]
pub struct TileQueue;

impl Strategy for TileQueue {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "threads pop tiles from a lock-free queue and write the tile's rows without a lock"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::Dynamic { chunk: 1 },
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(Queue { plan }))
    }
}

struct Queue {
    plan: Plan,
}

impl Renderer for Queue {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let tiles = image.tiles(self.plan.tile);
        let queue = ArrayQueue::new(tiles.len());
        for tile in tiles {
            // The queue has room for exactly these tiles.
            let _ = queue.push(tile);
        }
        let threads = iter::repeat_n(&queue, self.plan.threads.get());
        thread_team::run(NAME, threads, |team, queue| {
            while let Some(mut tile) = queue.pop() {
                team.render_tile(work, &mut tile)?;
            }
            Ok(())
        })
    }
}
