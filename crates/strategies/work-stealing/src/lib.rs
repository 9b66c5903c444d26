//! Lesson 11, `work-stealing`: each thread has tiles of its own, and takes another's when done.
//!
//! In OpenMP: no counterpart. rayon's threads have such deques too, but of halves of a range, and a
//! thief takes one.
//!
//! * **New**: a deque for each thread. Its owner takes tiles from the front, undisturbed by others;
//!   an idle thread takes half of another's from the back. The deques are `crossbeam`'s, after
//!   Chase and Lev (2005).
//! * **What it decides**: a first share for each thread, an equal range of the tiles.
//! * **What it costs**: cutting the image into tiles and filling the deques, starting the threads,
//!   a steal now and then, and at the end up to one tile's time of waiting.
//! * **When it is right**: for uneven work on many threads, which would all wait for one queue, and
//!   where neighbouring tiles find their data in the cache of one core.

use crossbeam::deque::{Steal, Stealer, Worker};
use rayweave_contract::*;
use rayweave_thread_team as thread_team;

/// A deque of tiles for each thread; idle threads steal.
pub static STRATEGY: Strategy = Strategy {
    name: "work-stealing",
    summary: "equal shares of the tiles: idle threads steal halves",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Tile, Scheduling::WorkStealing, Output::InPlace),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let mut tiles = image.tiles(plan.tile);
    let shares = thread_team::block_partition(tiles.len(), plan.threads);
    let deques = shares.map(|share| {
        let deque = Worker::new_lifo();
        // The owner takes tiles in the reverse order of their insertion.
        tiles.drain(..share.len()).rev().for_each(|tile| deque.push(tile));
        deque
    });
    let deques: Vec<Worker<Tile<'_>>> = deques.collect();
    let stealers: Vec<Stealer<Tile<'_>>> = deques.iter().map(Worker::stealer).collect();
    thread_team::run(deques.into_iter().enumerate(), |team, (own, deque)| {
        // No thread adds tiles, so one that finds all deques empty leaves. Tiles that are being
        // stolen are in no deque: a thread that looks then leaves early, and others compute them.
        while let Some(mut tile) = deque.pop().or_else(|| steal(own, &deque, &stealers)) {
            team.render_tile(work, &mut tile)?;
        }
        Ok(())
    })
}

/// Steals from the first other thread that has tiles, starting at the next one, so that not all
/// thieves meet. Half of its tiles come into `deque`, but for the one that is returned.
fn steal<T>(own: usize, deque: &Worker<T>, stealers: &[Stealer<T>]) -> Option<T> {
    let (before, after) = stealers.split_at(own);
    after.iter().skip(1).chain(before).find_map(|victim| {
        loop {
            match victim.steal_batch_with_limit_and_pop(deque, usize::MAX) {
                Steal::Success(tile) => return Some(tile),
                Steal::Empty => return None,
                // Another thread was faster.
                Steal::Retry => {}
            }
        }
    })
}
