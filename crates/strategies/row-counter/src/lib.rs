//! `row-counter`: a free thread takes the next row, by one atomic counter.
//!
//! * **What it decides**: nothing beforehand. The counter says which row is next; a thread takes a
//!   row by adding one to it, so the load balances itself down to a row.
//! * **What it costs**: an atomic addition and an uncontended lock a row (some 10 ns), starting the
//!   threads within every rendering, and every sample that a row shares with the rows above and
//!   below it.
//! * **When it is right**: for uneven work with many rows, each of which takes much longer than the
//!   addition. Tiles share more between their pixels.
//!
//! No two threads get the same number, but the compiler cannot know. So each row has a lock of its
//! own, which no other thread ever takes: its cost is the cost of safe Rust here.

use parking_lot::Mutex;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;
use std::iter;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};

const NAME: &str = "row-counter";

/// Threads that take the next row by a counter.
#[derive(Debug)]
pub struct RowCounter;

impl Strategy for RowCounter {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "threads take the next row by one atomic counter"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Row,
            scheduling: Scheduling::Dynamic { chunk: 1 },
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(Counter { threads: plan.threads }))
    }
}

struct Counter {
    threads: NonZeroUsize,
}

impl Renderer for Counter {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let width = image.width() as usize;
        let rows = image.pixels_mut().chunks_mut(width).enumerate();
        let rows: Vec<Mutex<Tile<'_>>> =
            rows.map(|(y, row)| Mutex::new(Tile::row(0, y as u32, row))).collect();
        let next = AtomicUsize::new(0);
        let threads = iter::repeat_n((), self.threads.get());
        thread_team::run(NAME, threads, |team, ()| {
            while let Some(row) = rows.get(next.fetch_add(1, Ordering::Relaxed)) {
                team.render_tile(work, &mut row.lock())?;
            }
            Ok(())
        })
    }
}
