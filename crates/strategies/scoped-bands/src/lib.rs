//! Lesson 2, `scoped-bands`: a thread for each of N bands of rows, with the standard library alone.
//!
//! In OpenMP: `#pragma omp parallel for schedule(static)` over the rows.
//!
//! * **New**: threads. `thread::scope` waits for its threads before it returns, so they may borrow
//!   the image. `split_off_mut` gives each thread rows that it alone may write: the compiler has
//!   proved that no lock is needed.
//! * **What it decides**: everything beforehand. The bands are equal but for one row.
//! * **What it costs**: starting the threads in every rendering. The image takes as long as the
//!   most expensive band.
//! * **When it is right**: for even work, where nothing can be cheaper, and as a first step.

use rayweave_contract::*;
use std::panic::resume_unwind;
use std::thread;

/// An equal band of rows for each thread.
pub static STRATEGY: Strategy = Strategy {
    name: "scoped-bands",
    summary: "an equal band of rows for each thread, fixed beforehand",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Band, Scheduling::Static, Output::InPlace),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let (width, height, threads) = (image.width(), image.height() as usize, plan.threads.get());
    let mut rest = image.pixels_mut();
    thread::scope(|scope| {
        let mut bands = Vec::new();
        for index in 0..threads {
            let (first, end) = (height * index / threads, height * (index + 1) / threads);
            let band = rest.split_off_mut(..(end - first) * width as usize).unwrap_or_default();
            // With more threads than rows, some have nothing to do.
            if !band.is_empty() {
                let mut tile = Tile::band(first as u32, width, band);
                // `scope.spawn` would panic where no more threads can be started.
                let thread = thread::Builder::new();
                let thread = thread.spawn_scoped(scope, move || render_tile(work, &mut tile));
                bands.push(thread.map_err(|source| RenderError::Spawn { threads, source })?);
            }
        }
        // `render_tile` makes an error of a panic, so no thread ends with one.
        bands.into_iter().try_for_each(|band| band.join().unwrap_or_else(|e| resume_unwind(e)))
    })
}
