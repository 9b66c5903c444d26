//! Lesson 4, `mutex-rows`: as `mutex-image`, but each thread locks the image once a row.
//!
//! In OpenMP: `schedule(static)` over the rows, and `#pragma omp critical` around the copy.
//!
//! * **New**: a thread computes a row into memory of its own and copies it under the lock. A lock's
//!   cost follows from how often it is taken and how long it is held.
//! * **What it decides**: everything beforehand. Each thread gets an equal range of the rows.
//! * **What it costs**: a lock and a copy for every row, starting the threads, and all of the
//!   imbalance.
//! * **When it is right**: when results go into something that cannot be split, such as a map or a
//!   file. The cost that remains is that of fixed shares.

use parking_lot::Mutex;
use rayweave_contract::*;
use rayweave_thread_team as thread_team;

/// Equal shares of the rows, a lock for each row.
pub static STRATEGY: Strategy = Strategy {
    name: "mutex-rows",
    summary: "equal shares of the rows, the image locked for each row",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Row, Scheduling::Static, Output::Mutex),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let image = Mutex::new(image);
    thread_team::run(thread_team::block_partition(height, plan.threads), |team, share| {
        let mut row = vec![[0.0; 3]; width];
        for y in share {
            team.render_tile(work, &mut Tile::row(0, y as u32, &mut row))?;
            image.lock().pixels_mut()[y * width..][..width].copy_from_slice(&row);
        }
        Ok(())
    })
}
