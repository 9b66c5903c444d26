//! `rayon-pixels`: a parallel loop over the pixels, as the lab report's `#pragma omp parallel for`.
//!
//! * **What it decides**: only that pixels are independent. rayon splits the range of pixels in
//!   halves as long as idle threads steal them, so an expensive corner is shared out without a
//!   plan for it.
//! * **What it costs**: a pool that is started once (some 100 us), a call of the work for every
//!   pixel, and no sharing of anything between neighbouring pixels.
//! * **When it is right**: first. It is one line away from the sequential loop and hard to get
//!   wrong; leave it when a profile shows the price of such small items.
//!
//! The pool is its own, with exactly the requested threads: rayon's global pool has as many as the
//! machine has cores, whatever a caller wants to measure.

use rayon::ThreadPool;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work, render_tile,
};

const NAME: &str = "rayon-pixels";

/// A loop of rayon over pixels, in a pool of its own.
#[derive(Debug)]
pub struct RayonPixels;

impl Strategy for RayonPixels {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "one rayon item a pixel, halves of the range stolen by idle threads"
    }

    fn threads(&self) -> Threads {
        Threads::Pool
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Pixel,
            scheduling: Scheduling::RecursiveSplit,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(PixelLoop { pool: rayweave_rayon_pool::build(NAME, plan.threads)? }))
    }
}

struct PixelLoop {
    pool: ThreadPool,
}

impl Renderer for PixelLoop {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let width = image.width() as usize;
        self.pool.install(|| {
            image.pixels_mut().par_iter_mut().enumerate().try_for_each(|(index, color)| {
                let (x, y) = ((index % width) as u32, (index / width) as u32);
                render_tile(NAME, work, &mut Tile::pixel(x, y, color))
            })
        })
    }
}
