//! `std-mutex-image`: `mutex-image` once more, with the lock of the standard library.
//!
//! * **What it decides**: what `mutex-image` decides: an equal range of pixels for each thread.
//! * **What it costs**: the same, but for the lock: `std::sync::Mutex` instead of `parking_lot`'s.
//!   It remembers whether a thread panicked while holding it, and where threads meet it asks the
//!   operating system sooner or later than the other.
//! * **When it is right**: never for this loop, as `mutex-image`. It is here because a C++
//!   program's `std::mutex` would be rewritten to it, and to show in one table whether the choice
//!   of a lock matters.

use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;
use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};

const NAME: &str = "std-mutex-image";

/// The strategy `mutex-image` with the lock of the standard library.
#[derive(Debug)]
pub struct StdMutexImage;

impl Strategy for StdMutexImage {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "as mutex-image, with the standard library's lock"
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
                // No panic can occur while it is held: a poisoned lock means nothing here.
                image.lock().unwrap_or_else(PoisonError::into_inner).pixels_mut()[index] = color;
            }
            Ok(())
        })
    }
}
