//! `rayon-rows`: a parallel loop over the rows, as `#pragma omp parallel for` around the outer of
//! two loops.
//!
//! * **What it decides**: that a row is the smallest unit of work. rayon splits the range of rows
//!   in halves as long as idle threads steal them, never below [`MIN_LEN`].
//! * **What it costs**: a pool that is started once (some 100 us), and every sample that a row
//!   shares with the rows above and below it.
//! * **When it is right**: where a loop over rows is already there, and a row takes microseconds or
//!   more. It is as short as `rayon-pixels` and calls the work once a row.
//!
//! The pool is its own, with exactly the requested threads: rayon's global pool has as many as the
//! machine has cores, whatever a caller wants to measure.

use rayon::ThreadPool;
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work, render_tile,
};

const NAME: &str = "rayon-rows";

/// The rows that rayon does not split further: a row is worth stealing, and where the last ones are
/// expensive no thread should be left with two.
pub const MIN_LEN: usize = 1;

/// A loop of rayon over rows, in a pool of its own.
#[derive(Debug)]
pub struct RayonRows;

impl Strategy for RayonRows {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "one rayon item a row, halves of the range stolen by idle threads"
    }

    fn threads(&self) -> Threads {
        Threads::Pool
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Row,
            scheduling: Scheduling::RecursiveSplit,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(RowLoop { pool: rayweave_rayon_pool::build(NAME, plan.threads)? }))
    }
}

struct RowLoop {
    pool: ThreadPool,
}

impl Renderer for RowLoop {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let width = image.width() as usize;
        let rows = image.pixels_mut().par_chunks_mut(width).enumerate().with_min_len(MIN_LEN);
        self.pool.install(|| {
            rows.try_for_each(|(y, row)| render_tile(NAME, work, &mut Tile::row(0, y as u32, row)))
        })
    }
}
