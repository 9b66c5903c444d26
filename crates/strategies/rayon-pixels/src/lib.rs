//! Lesson 8, `rayon-pixels`: a parallel loop over the pixels.
//!
//! In OpenMP: `#pragma omp parallel for collapse(2)` over the two loops, but idle threads steal.
//!
//! * **New**: a library spreads the loop. rayon halves the range of pixels until there are about
//!   twice as many parts as threads. A stolen part is halved again; a part that nobody steals is
//!   not. rayon's threads wait in a pool, started once.
//! * **What it decides**: that pixels are independent, and nothing else.
//! * **What it costs**: a call of the work for every pixel. Whatever neighbouring pixels could
//!   share or compute side by side is lost (`--equal-work off` shows how much that is here).
//!   Neighbouring expensive pixels may stay with one thread (lesson 10).
//! * **When it is right**: as the first thing to try. It is one line away from the sequential loop
//!   and hard to get wrong. Leave it when single items are too small, or share work.

use rayon::prelude::*;
use rayweave_contract::*;

/// A loop of rayon over pixels.
pub static STRATEGY: Strategy = Strategy {
    name: "rayon-pixels",
    summary: "rayon's loop over the pixels: idle threads steal halves",
    threads: Threads::Pool,
    policy: Policy::new(Granularity::Pixel, Scheduling::RecursiveSplit, Output::InPlace),
    unavailable: None,
    prepare: &|plan| {
        let pool = rayweave_rayon_pool::build(plan.threads)?;
        renderer(move |work, image| pool.install(|| render(work, image)))
    },
};

fn render(work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let width = image.width() as usize;
    image.pixels_mut().par_iter_mut().enumerate().try_for_each(|(index, color)| {
        let (x, y) = ((index % width) as u32, (index / width) as u32);
        render_tile(work, &mut Tile::pixel(x, y, color))
    })
}
