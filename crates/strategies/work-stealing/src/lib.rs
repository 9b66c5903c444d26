//! `work-stealing`: each thread has tiles of its own, and takes another's when they are done.
//!
//! * **What it decides**: a first share for each thread, an equal range of the tiles. A thread
//!   takes its own from the front; an idle thread takes half of another's from the back.
//! * **What it costs**: cutting the image into tiles and queueing them, starting the threads
//!   within every rendering, and at the end up to one tile's time of waiting. To take one of its
//!   own tiles costs a thread a few ns, whatever the other threads do; a steal some 100 ns.
//! * **When it is right**: for uneven work on many threads, which would all wait for one queue; and
//!   where neighbouring tiles in one thread find their data in its cache.
//!
//! The deques are `crossbeam`'s, after Chase and Lev (2005). No thread adds tiles, so a thread that
//! finds all deques empty leaves. For a moment stolen tiles are in no deque, and a thread that
//! looks then leaves too early: fewer threads share the rest, and nothing is lost.

use crossbeam::deque::{Steal, Stealer, Worker};
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;

const NAME: &str = "work-stealing";

/// A deque of tiles for each thread; idle threads steal.
#[derive(Debug)]
pub struct WorkStealing;

impl Strategy for WorkStealing {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "an equal range of the tiles a thread; an idle thread steals half of another's"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::WorkStealing,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(Deques { plan }))
    }
}

struct Deques {
    plan: Plan,
}

impl Renderer for Deques {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let tiles = image.tiles(self.plan.tile);
        let shares = thread_team::block_partition(tiles.len(), self.plan.threads);
        let mut tiles = tiles.into_iter();
        let deques: Vec<Worker<Tile<'_>>> = shares
            .map(|share| {
                let deque = Worker::new_lifo();
                let own: Vec<Tile<'_>> = tiles.by_ref().take(share.len()).collect();
                // The owner takes tiles in the reverse order of their insertion.
                own.into_iter().rev().for_each(|tile| deque.push(tile));
                deque
            })
            .collect();
        let stealers: Vec<Stealer<Tile<'_>>> = deques.iter().map(Worker::stealer).collect();
        thread_team::run(NAME, deques.into_iter().enumerate(), |team, (own, deque)| {
            while let Some(mut tile) = deque.pop().or_else(|| steal(own, &deque, &stealers)) {
                team.render_tile(work, &mut tile)?;
            }
            Ok(())
        })
    }
}

/// Steals a tile from the first other thread that has some, starting at the next one, so that not
/// all thieves meet. Half of the rest of that thread's tiles come into `deque`.
fn steal<'a>(
    own: usize,
    deque: &Worker<Tile<'a>>,
    stealers: &[Stealer<Tile<'a>>],
) -> Option<Tile<'a>> {
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
