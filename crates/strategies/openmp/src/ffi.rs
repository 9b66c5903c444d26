//! OpenMP, called from Rust: the one place of this workspace with `unsafe` code.

use crate::Schedule;
use std::ffi::{c_int, c_void};

/// One iteration of a loop: called from several threads at once, each time for another number.
type Body<'a> = dyn Fn(usize) + Sync + 'a;

type Iteration = extern "C" fn(*const c_void, usize);

type Loop = unsafe extern "C" fn(c_int, usize, Iteration, *const c_void);

// SAFETY: as `loops.h` declares them. `start` and `end` take and give plain numbers, and may be
// called at any time outside of a loop, which is where safe code always is; a loop calls `compute`
// while it runs and never after.
unsafe extern "C" {
    safe fn rayweave_openmp_start(threads: c_int) -> c_int;
    safe fn rayweave_openmp_end();
    fn rayweave_openmp_static(
        threads: c_int,
        count: usize,
        compute: Iteration,
        context: *const c_void,
    );
    fn rayweave_openmp_dynamic(
        threads: c_int,
        count: usize,
        compute: Iteration,
        context: *const c_void,
    );
    fn rayweave_openmp_guided(
        threads: c_int,
        count: usize,
        compute: Iteration,
        context: *const c_void,
    );
}

/// Starts the threads of the calling thread's loops, and returns their number with itself.
pub fn start(threads: c_int) -> c_int {
    rayweave_openmp_start(threads)
}

/// Ends the threads of the calling thread's loops; another loop would start them again.
pub fn end() {
    rayweave_openmp_end();
}

/// Calls `body` once for each number below `count`, on so many threads. It must not panic: that
/// would end the process.
pub fn for_each(schedule: Schedule, threads: c_int, count: usize, body: &Body<'_>) {
    let run: Loop = match schedule {
        Schedule::Static => rayweave_openmp_static,
        Schedule::Dynamic => rayweave_openmp_dynamic,
        Schedule::Guided => rayweave_openmp_guided,
    };
    // SAFETY: `iteration` casts the context back to a pointer to `body`, which it is. `body` lives
    // until the loop has returned, and being `Sync` may be called from its threads.
    unsafe { run(threads, count, iteration, (&raw const body).cast()) }
}

/// Calls the body. A panic that came so far would end the process, not unwind through C.
extern "C" fn iteration(context: *const c_void, index: usize) {
    // SAFETY: the pointer that `for_each` gave to the loop that calls this.
    let body = unsafe { *context.cast::<&Body<'_>>() };
    body(index);
}
