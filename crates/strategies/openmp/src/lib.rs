//! Lesson 13, `openmp-static`, `openmp-dynamic`, `openmp-guided`: OpenMP's own loop over the tiles.
//!
//! In the lab report: `static` and `dynamic, 1`, over columns. `loops.c` has the three pragmas; the
//! work is in Rust.
//!
//! * **New**: a loop in C calls Rust from its threads, at the price of `unsafe` (in `ffi`).
//! * **What it decides**: `static` deals out equal ranges of the tiles beforehand; with `dynamic` a
//!   free thread takes the next tile, with `guided` a part of the remaining tiles (gcc: divided by
//!   N).
//! * **What it costs**: a C compiler at build time, and an uncontended lock for every tile, since
//!   the compiler cannot know that OpenMP gives each index to one thread.
//! * **When it is right**: when a program in C or C++ has OpenMP already, and its loops call Rust.
//!   In Rust alone `tile-queue` does what `dynamic` does, and `scoped-bands` what `static` does,
//!   without `unsafe`.
//!
//! The caller's thread is one of the N. `OMP_PROC_BIND`, `OMP_PLACES` and `OMP_WAIT_POLICY` work as
//! in C. The number of threads is the requested one, whatever `OMP_NUM_THREADS` or `OMP_DYNAMIC`
//! say, and an error where `OMP_THREAD_LIMIT` is lower.

use rayweave_contract::*;

#[cfg(openmp)]
#[allow(unsafe_code)] // To call C.
mod ffi;
#[cfg(openmp)]
mod team_loop;

/// The loop with `schedule(static)`.
pub static STATIC: Strategy = strategy(
    "openmp-static",
    "OpenMP's loop over the tiles: equal shares, fixed beforehand",
    Scheduling::Static,
    &|plan| prepare(Schedule::Static, plan),
);
/// The loop with `schedule(dynamic, 1)`.
pub static DYNAMIC: Strategy = strategy(
    "openmp-dynamic",
    "OpenMP's loop over the tiles: the next to a free thread",
    Scheduling::Dynamic { chunk: 1 },
    &|plan| prepare(Schedule::Dynamic, plan),
);
/// The loop with `schedule(guided, 1)`.
pub static GUIDED: Strategy = strategy(
    "openmp-guided",
    "OpenMP's loop over the tiles: the next ones, in shrinking chunks",
    Scheduling::Guided,
    &|plan| prepare(Schedule::Guided, plan),
);

const fn strategy(
    name: &'static str,
    summary: &'static str,
    scheduling: Scheduling,
    prepare: &'static Prepare<'static>,
) -> Strategy<'static> {
    let (threads, policy) =
        (Threads::Pool, Policy::new(Granularity::Tile, scheduling, Output::InPlace));
    // The reason why the build script found no OpenMP, if it found none.
    let unavailable = option_env!("WITHOUT_OPENMP");
    Strategy { name, summary, threads, policy, unavailable, prepare }
}

#[derive(Clone, Copy, Debug)]
enum Schedule {
    Static,
    Dynamic,
    Guided,
}

#[cfg(openmp)]
fn prepare(schedule: Schedule, plan: Plan) -> Result<RenderFn, RenderError> {
    let mut team_loop = team_loop::TeamLoop::start(schedule, plan)?;
    renderer(move |work, image| team_loop.render(work, image))
}

#[cfg(not(openmp))]
fn prepare(_: Schedule, _: Plan) -> Result<RenderFn, RenderError> {
    Err(RenderError::Unavailable("it was built without OpenMP"))
}
