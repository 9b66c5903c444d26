//! `mutex-rows`: as `mutex-image`, but the lock around the image is taken once a row.
//!
//! * **What it decides**: everything beforehand. Thread `i` of `n` gets the `i`-th of `n` equal
//!   ranges of rows, computes a row into memory of its own, and copies it under the lock.
//! * **What it costs**: a lock and a copy for every row, starting the threads within every
//!   rendering, every sample that a row shares with its neighbours, and all of the imbalance of the
//!   image.
//! * **When it is right**: when results go into something that cannot be cut into disjoint parts,
//!   such as a map or a file. Compared with `mutex-image` it shows that the cost of a lock follows
//!   from how often it is taken. The remaining cost is that of fixed shares.

use parking_lot::Mutex;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;
use std::num::NonZeroUsize;

const NAME: &str = "mutex-rows";

/// Hand-spawned threads, a static share of the rows each, one lock around the image.
#[derive(Debug)]
pub struct MutexRows;

impl Strategy for MutexRows {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "an equal share of the rows a thread, one mutex around the image, locked for each row"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Row,
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
        let (width, height) = (image.width() as usize, image.height() as usize);
        let shares = thread_team::block_partition(height, self.threads);
        let image = Mutex::new(image);
        thread_team::run(NAME, shares, |team, share| {
            let mut row = vec![[0.0; 3]; width];
            for y in share {
                team.render_tile(work, &mut Tile::row(0, y as u32, &mut row))?;
                image.lock().pixels_mut()[y * width..][..width].copy_from_slice(&row);
            }
            Ok(())
        })
    }
}
