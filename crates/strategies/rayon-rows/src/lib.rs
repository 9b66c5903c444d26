//! Lesson 9, `rayon-rows`: a parallel loop over the rows.
//!
//! In the lab report: `#pragma omp parallel for` over the outer loop, there over columns.
//!
//! * **New**: larger items. The loop is as short as that over pixels, and calls the work once a
//!   row, so neighbouring pixels of a row can share work.
//! * **What it decides**: that a row is the smallest piece of work.
//! * **What it costs**: whatever a row could share with the rows above and below it.
//! * **When it is right**: where a loop over rows, lines or records is there already, and one of
//!   them takes microseconds or more.

use rayon::prelude::*;
use rayweave_contract::*;

/// A loop of rayon over rows.
pub static STRATEGY: Strategy = Strategy {
    name: "rayon-rows",
    summary: "rayon's loop over the rows: idle threads steal halves",
    threads: Threads::Pool,
    policy: Policy::new(Granularity::Row, Scheduling::RecursiveSplit, Output::InPlace),
    unavailable: None,
    prepare: &|plan| {
        let pool = rayweave_rayon_pool::build(plan.threads)?;
        renderer(move |work, image| pool.install(|| render(work, image)))
    },
};

fn render(work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let width = image.width() as usize;
    let rows = image.pixels_mut().par_chunks_mut(width).enumerate();
    rows.try_for_each(|(y, row)| render_tile(work, &mut Tile::row(0, y as u32, row)))
}
