//! `scoped-bands`: one scoped thread for each of N bands of rows, and nothing else.
//!
//! * **What it decides**: everything beforehand. The image is cut into as many bands of whole
//!   rows as there are threads, equal but for one row; a thread computes its band as one large
//!   tile.
//! * **What it costs**: starting the threads within every rendering, and all of the imbalance of
//!   the image: it takes as long as its most expensive band. There is no lock and no queue, and
//!   only the rows on either side of a cut share no samples.
//! * **When it is right**: for even work, where nothing can be cheaper; and as a first step, since
//!   it needs the standard library alone. Once some rows cost more than others, leave it.
//!
//! `split_off_mut` hands each thread the rows that it alone may write, so the compiler has proved
//! that no lock is needed. A band that has begun is computed to its end, even when another one has
//! failed.

use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;
use std::num::NonZeroUsize;

const NAME: &str = "scoped-bands";

/// Scoped threads, a band of rows each.
#[derive(Debug)]
pub struct ScopedBands;

impl Strategy for ScopedBands {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "an equal band of rows a thread, each computed at once, without a lock"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Band,
            scheduling: Scheduling::Static,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(Bands { threads: plan.threads }))
    }
}

struct Bands {
    threads: NonZeroUsize,
}

impl Renderer for Bands {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let (width, height) = (image.width(), image.height() as usize);
        let mut rest = image.pixels_mut();
        let bands = thread_team::block_partition(height, self.threads).map(|rows| {
            let band = rest.split_off_mut(..rows.len() * width as usize).unwrap_or_default();
            (rows.start as u32, band)
        });
        thread_team::run(NAME, bands, |team, (y, band)| {
            // With more threads than rows, some have nothing to do.
            if band.is_empty() {
                return Ok(());
            }
            team.render_tile(work, &mut Tile::band(y, width, band))
        })
    }
}
