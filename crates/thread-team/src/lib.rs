//! Starts scoped threads, joins them, and stops all of them when one fails. Strategies that start
//! threads by hand share it.
//!
//! Each call of [`run`] starts the threads anew; none outlives the call. The caller's thread does
//! not compute, because Linux often leaves a new thread on the core of the thread that started it
//! until the next load balancing some milliseconds later.

use rayweave_contract::{RenderError, Tile, Work, render_tile};
use std::iter;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// The signal that a thread of the team failed: a body that receives it returns at once.
#[derive(Debug)]
pub struct Stop;

/// The shared state of threads that stop together: those that [`run`] starts, or a library's, for
/// which `Team::default()` makes one.
#[derive(Debug, Default)]
pub struct Team {
    stopped: AtomicBool,
    first_error: Mutex<Option<RenderError>>,
}

/// Runs `body` on one thread for each of `shares`, all at the same time, and waits for them.
///
/// A share is the part that one thread works on: a range, slices of the image, or a reference to a
/// queue that all threads take from.
///
/// # Errors
///
/// The first failure: the work panicked, or a thread could not be started. The other threads stop
/// at their next tile and are joined before this returns.
pub fn run<Share: Send>(
    shares: impl ExactSizeIterator<Item = Share>,
    body: impl Fn(&Team, Share) -> Result<(), Stop> + Sync,
) -> Result<(), RenderError> {
    run_with(shares, body, || {})
}

/// Runs `body` as [`run`] does, and `meanwhile` on the caller's thread. `meanwhile` begins once the
/// threads are started, or one could not be; it has to end when the threads do.
///
/// # Errors
///
/// As [`run`].
pub fn run_with<Share: Send>(
    shares: impl ExactSizeIterator<Item = Share>,
    body: impl Fn(&Team, Share) -> Result<(), Stop> + Sync,
    meanwhile: impl FnOnce(),
) -> Result<(), RenderError> {
    let threads = shares.len();
    let team = Team::default();
    let (team_ref, body) = (&team, &body);
    thread::scope(|scope| {
        for (index, share) in shares.enumerate() {
            let thread = thread::Builder::new().name(format!("thread {index}"));
            // The team keeps the failure, so `Stop` carries nothing more.
            if let Err(source) = thread.spawn_scoped(scope, move || drop(body(team_ref, share))) {
                team_ref.fail(RenderError::Spawn { threads, source });
                break;
            }
        }
        meanwhile();
    });
    team.outcome()
}

/// Probes whether `threads` threads can run at the same time: starts them, and ends them when the
/// last has begun. Call it before a library that aborts or panics when it cannot start its threads.
///
/// # Errors
///
/// A thread could not be started.
pub fn probe(threads: NonZeroUsize) -> Result<(), RenderError> {
    let gate = Mutex::new(());
    let closed = gate.lock();
    let wait = |_: &Team, ()| {
        drop(gate.lock());
        Ok(())
    };
    run_with(iter::repeat_n((), threads.get()), wait, || drop(closed))
}

/// Partitions `count` pieces into one contiguous range for each thread. The lengths differ by one
/// piece at most; some are 0 if there are more threads than pieces.
pub fn block_partition(
    count: usize,
    threads: NonZeroUsize,
) -> impl ExactSizeIterator<Item = Range<usize>> {
    let threads = threads.get();
    (0..threads).map(move |share| count * share / threads..count * (share + 1) / threads)
}

impl Team {
    /// Renders one tile, unless the team has stopped.
    ///
    /// # Errors
    ///
    /// [`Stop`] if the work fails, or has failed on another thread.
    pub fn render_tile(&self, work: &dyn Work, tile: &mut Tile<'_>) -> Result<(), Stop> {
        if self.stopped.load(Ordering::Relaxed) {
            return Err(Stop);
        }
        render_tile(work, tile).map_err(|error| self.fail(error))
    }

    /// Returns the result of the whole team. Call it after the last thread has ended.
    ///
    /// # Errors
    ///
    /// The first failure.
    pub fn outcome(self) -> Result<(), RenderError> {
        let first_error = self.first_error.into_inner().unwrap_or_else(PoisonError::into_inner);
        first_error.map_or(Ok(()), Err)
    }

    fn fail(&self, error: RenderError) -> Stop {
        let mut first = self.first_error.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
        self.stopped.store(true, Ordering::Relaxed);
        Stop
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    #[test]
    fn blocks_differ_by_one_piece_at_most_and_cover_all() {
        for (count, threads) in [(0, 3), (1, 1), (2, 5), (10, 3), (7, 7), (500, 64)] {
            let threads = NonZeroUsize::new(threads).expect("not 0");
            let shares: Vec<Range<usize>> = block_partition(count, threads).collect();
            assert_eq!(shares.len(), threads.get());
            assert!(shares.iter().cloned().flatten().eq(0..count), "{shares:?}");
            let (least, most) = (count / threads, count.div_ceil(threads.get()));
            assert!(shares.iter().all(|share| (least..=most).contains(&share.len())), "{shares:?}");
        }
    }

    /// Catches a sender that outlives its thread: the receiver would wait forever.
    #[test]
    fn the_caller_runs_its_own_part_beside_the_team() {
        let (sender, receiver) = mpsc::channel();
        let mut received = Vec::new();
        let send = |_: &Team, (index, sender): (usize, mpsc::Sender<usize>)| {
            sender.send(index).map_err(|_| Stop)
        };
        let senders = iter::repeat_n(sender, 5).enumerate();
        run_with(senders, send, || received.extend(receiver)).expect("the threads start");
        received.sort_unstable();
        assert_eq!(received, [0, 1, 2, 3, 4]);
    }

    /// Catches a share that runs on the caller's thread: new threads may wait behind it.
    #[test]
    fn no_share_runs_on_the_callers_thread() {
        let (caller, ran) = (thread::current().id(), Mutex::new(Vec::new()));
        let note = |_: &Team, share: usize| {
            let by_caller = thread::current().id() == caller;
            ran.lock().unwrap_or_else(PoisonError::into_inner).push((share, by_caller));
            Ok(())
        };
        run(0..5, note).expect("the threads start");
        let mut ran = ran.into_inner().expect("nobody panicked");
        ran.sort_unstable();
        assert!(ran.into_iter().eq((0..5).map(|share| (share, false))));
    }

    #[test]
    fn a_probe_starts_all_threads() {
        probe(NonZeroUsize::new(20).expect("not 0")).expect("20 threads start");
    }
}
