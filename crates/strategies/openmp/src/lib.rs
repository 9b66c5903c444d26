//! `openmp-static`, `openmp-dynamic`, `openmp-guided`: the lab report's own way, OpenMP's parallel
//! loop, with the C compiler's OpenMP and the work in Rust.
//!
//! * **What it decides**: `static` everything beforehand: each thread gets one of N equal ranges of
//!   tiles. `dynamic` nothing: a free thread takes the next tile. `guided` begins with large
//!   chunks, the remaining tiles over N, and ends with single tiles.
//! * **What it costs**: a C compiler at build time, unsafe code at the border, an uncontended lock
//!   a tile (some 10 ns: the compiler cannot know that OpenMP gives each index to one thread), and
//!   threads that are started once. `static` has all of the imbalance of the image, `dynamic` an
//!   atomic addition a tile, `guided` fewer of them.
//! * **When it is right**: when a program in C or C++ has OpenMP already, and Rust is called from
//!   its loops. In Rust alone `tile-queue` or `rayon-tiles` do the same without `unsafe`.
//!
//! The caller's thread is one of the N. `OMP_PROC_BIND`, `OMP_PLACES` and `OMP_WAIT_POLICY` work as
//! ever. The number of threads is the requested one, whatever `OMP_NUM_THREADS` or `OMP_DYNAMIC`
//! say, and an error where `OMP_THREAD_LIMIT` is lower. Built without OpenMP these strategies are
//! unavailable, and say what was missing.

use rayweave_contract::{
    Granularity, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError, Threads,
};

#[cfg(openmp)]
#[allow(unsafe_code)] // To call C.
mod ffi;
#[cfg(openmp)]
mod renderer;

/// A loop of OpenMP over tiles.
#[derive(Debug)]
pub struct OpenMp(Schedule);

/// The loop with `schedule(static)`.
pub static STATIC: OpenMp = OpenMp(Schedule::Static);
/// The loop with `schedule(dynamic, 1)`.
pub static DYNAMIC: OpenMp = OpenMp(Schedule::Dynamic);
/// The loop with `schedule(guided, 1)`.
pub static GUIDED: OpenMp = OpenMp(Schedule::Guided);

#[derive(Clone, Copy, Debug)]
enum Schedule {
    Static,
    Dynamic,
    Guided,
}

impl Strategy for OpenMp {
    fn name(&self) -> &'static str {
        match self.0 {
            Schedule::Static => "openmp-static",
            Schedule::Dynamic => "openmp-dynamic",
            Schedule::Guided => "openmp-guided",
        }
    }

    fn summary(&self) -> &'static str {
        match self.0 {
            Schedule::Static => "OpenMP: an equal range of the tiles a thread",
            Schedule::Dynamic => "OpenMP: threads take the next tile",
            Schedule::Guided => "OpenMP: threads take the next tiles, ever fewer",
        }
    }

    fn threads(&self) -> Threads {
        Threads::Pool
    }

    fn policy(&self) -> Policy {
        let scheduling = match self.0 {
            Schedule::Static => Scheduling::Static,
            Schedule::Dynamic => Scheduling::Dynamic { chunk: 1 },
            Schedule::Guided => Scheduling::Guided,
        };
        Policy { granularity: Granularity::Tile, scheduling, output: Output::InPlace }
    }

    fn unavailable(&self) -> Option<&'static str> {
        // The reason why the build script found no OpenMP, if it found none.
        option_env!("WITHOUT_OPENMP")
    }

    #[cfg(openmp)]
    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(renderer::TileLoop::start(self.name(), self.0, plan)?))
    }

    #[cfg(not(openmp))]
    fn prepare(&self, _: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        let reason = self.unavailable().unwrap_or_default();
        Err(StrategyError::Unavailable { strategy: self.name(), reason })
    }
}
