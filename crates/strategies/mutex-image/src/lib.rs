//! `mutex-image`: the lab report's second way, threads by hand and one lock around the image.
//!
//! * **What it decides**: everything beforehand. Thread `i` of `n` gets the `i`-th of `n` equal
//!   ranges of pixels; a thread that is done early waits for the slowest.
//! * **What it costs**: a lock and unlock for every pixel (some 5 ns uncontended, several times
//!   that when two threads meet), starting the threads within every rendering, and all of the
//!   imbalance of the image: if one range has the expensive corner, one thread does the work.
//! * **When it is right**: never for this loop, since pixels are disjoint and need no lock. It is
//!   here because the report did it, because it is a common first attempt, and because the table
//!   shows which of its two mistakes costs more.

use parking_lot::Mutex;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;
use std::num::NonZeroUsize;

const NAME: &str = "mutex-image";

/// Hand-spawned threads, a static share of the pixels each, one lock around the image.
#[derive(Debug)]
pub struct MutexImage;

impl Strategy for MutexImage {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "an equal share of the pixels a thread, one mutex around the image, locked for each pixel"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Pixel,
            scheduling: Scheduling::Static,
            output: Output::Mutex,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(StaticShares { threads: plan.threads }))
    }
}

struct StaticShares {
    threads: NonZeroUsize,
}

impl Renderer for StaticShares {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let (width, pixels) = (image.width() as usize, image.pixels().len());
        let shares = thread_team::block_partition(pixels, self.threads);
        let image = Mutex::new(image);
        thread_team::run(NAME, shares, |team, share| {
            for index in share {
                // Computed into memory of the thread's own: the lock is held for the copy only.
                let (x, y) = ((index % width) as u32, (index / width) as u32);
                let mut color = [0.0; 3];
                team.render_tile(work, &mut Tile::pixel(x, y, &mut color))?;
                image.lock().pixels_mut()[index] = color;
            }
            Ok(())
        })
    }
}
