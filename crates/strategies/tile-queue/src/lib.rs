//! Lesson 7, `tile-queue`: a free thread takes the next tile from a lock-free queue.
//!
//! In OpenMP: `#pragma omp parallel for schedule(dynamic, 1)` over the tiles.
//!
//! * **New**: a queue of tiles that own what they write. A tile has the slices of the rows that it
//!   covers, and no pixel is in two tiles. So threads write without a lock, and the compiler has
//!   proved that they may. The size of a tile is a parameter.
//! * **What it decides**: nothing beforehand.
//! * **What it costs**: cutting the image into tiles, a pop for every tile, starting the threads,
//!   and at the end up to one tile's time of waiting.
//! * **When it is right**: for uneven work whose cost is not known. Tiles should be small enough
//!   that the last one does not matter, and large enough to share work between their pixels.

use crossbeam::queue::ArrayQueue;
use rayweave_contract::*;
use rayweave_thread_team as thread_team;
use std::iter;

/// The next tile by a queue.
pub static STRATEGY: Strategy = Strategy {
    name: "tile-queue",
    summary: "the next tile to a free thread, from a lock-free queue",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Tile, Scheduling::Dynamic { chunk: 1 }, Output::InPlace),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let tiles = image.tiles(plan.tile);
    let queue = ArrayQueue::new(tiles.len());
    for tile in tiles {
        // The queue has room for exactly these tiles.
        let _ = queue.push(tile);
    }
    thread_team::run(iter::repeat_n(&queue, plan.threads.get()), |team, queue| {
        while let Some(mut tile) = queue.pop() {
            team.render_tile(work, &mut tile)?;
        }
        Ok(())
    })
}
