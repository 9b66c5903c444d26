//! Lesson 6, `row-counter`: a free thread takes the next row, by one atomic counter.
//!
//! In OpenMP: `#pragma omp parallel for schedule(dynamic, 1)` over the rows; the lab report has it
//! over the columns.
//!
//! * **New**: the counter of lesson 5 without the channel: threads write rows in place. While one
//!   computes an expensive row, the others take more of the rest.
//! * **What it decides**: nothing beforehand.
//! * **What it costs**: an atomic addition and a lock for every row, and starting the threads. No
//!   two threads get the same number, but the compiler cannot know. So each row has a lock of its
//!   own, which no other thread ever takes: the price of safe Rust here.
//! * **When it is right**: for uneven work with many rows, each of which takes much longer than the
//!   addition.

use parking_lot::Mutex;
use rayweave_contract::*;
use rayweave_thread_team as thread_team;
use std::iter;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The next row by a counter.
pub static STRATEGY: Strategy = Strategy {
    name: "row-counter",
    summary: "the next row to a free thread, by an atomic counter",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Row, Scheduling::Dynamic { chunk: 1 }, Output::InPlace),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let width = image.width() as usize;
    let rows = image.pixels_mut().chunks_mut(width).enumerate();
    let rows: Vec<_> = rows.map(|(y, row)| Mutex::new(Tile::row(0, y as u32, row))).collect();
    let next = AtomicUsize::new(0);
    thread_team::run(iter::repeat_n((), plan.threads.get()), |team, ()| {
        while let Some(row) = rows.get(next.fetch_add(1, Ordering::Relaxed)) {
            team.render_tile(work, &mut row.lock())?;
        }
        Ok(())
    })
}
