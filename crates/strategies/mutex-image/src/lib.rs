//! Lesson 3, `mutex-image` and `std-mutex-image`: equal shares of the pixels, one lock.
//!
//! In the lab report: `std::thread` with equal shares of the pixels, a `std::mutex` for each pixel.
//!
//! * **New**: a mutex. Threads may share the image without splitting it, and write to it one at a
//!   time. `thread_team::run` starts and joins threads as lesson 2 does, and stops all of them when
//!   one fails.
//! * **What it decides**: everything beforehand. Each thread gets an equal range of the pixels.
//! * **What it costs**: a lock for every pixel, starting the threads, and all of the imbalance:
//!   if one range has the expensive corner, one thread does the work.
//! * **When it is right**: never here, since pixels are disjoint and need no lock. Compare it with
//!   lesson 2, which has the same imbalance, no lock, and one call for each band only.
//!   `std-mutex-image` has the lock of the standard library in place of `parking_lot`'s, to show
//!   whether the choice matters.

use rayweave_contract::*;
use rayweave_thread_team as thread_team;
use std::sync::PoisonError;

/// Equal shares of the pixels, `parking_lot`'s mutex.
pub static STRATEGY: Strategy = Strategy {
    name: "mutex-image",
    summary: "equal shares of the pixels, the image locked for each pixel",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Pixel, Scheduling::Static, Output::Mutex),
    unavailable: None,
    prepare: &|plan| {
        renderer(move |work, image| {
            let size = (image.width(), image.height());
            let image = parking_lot::Mutex::new(image);
            render(plan, work, size, |index, color| image.lock().pixels_mut()[index] = color)
        })
    },
};

/// Equal shares of the pixels, the standard library's mutex.
pub static WITH_STD: Strategy = Strategy {
    name: "std-mutex-image",
    summary: "as mutex-image, with the standard library's lock",
    prepare: &|plan| {
        renderer(move |work, image| {
            let size = (image.width(), image.height());
            let image = std::sync::Mutex::new(image);
            render(plan, work, size, |index, color| {
                // No thread panics while it holds the lock, so it is never poisoned.
                image.lock().unwrap_or_else(PoisonError::into_inner).pixels_mut()[index] = color;
            })
        })
    },
    ..STRATEGY
};

fn render(
    plan: Plan,
    work: &dyn Work,
    (width, height): (u32, u32),
    store: impl Fn(usize, Rgb) + Sync,
) -> Result<(), RenderError> {
    let shares = thread_team::block_partition(width as usize * height as usize, plan.threads);
    thread_team::run(shares, |team, share| {
        for index in share {
            let (x, y) = (index % width as usize, index / width as usize);
            // The thread's own memory: the lock is held for the copy only.
            let mut color = [0.0; 3];
            team.render_tile(work, &mut Tile::pixel(x as u32, y as u32, &mut color))?;
            store(index, color);
        }
        Ok(())
    })
}
