//! Forks scoped threads, joins them, and lets them stop together: what every strategy with
//! hand-spawned threads needs, and no strategy should have to say twice.
//!
//! The team is forked at each call of [`run`]; nothing outlives it. The caller's thread only waits.
//! As a member it would be one thread less to start, but Linux often leaves a new thread behind the
//! one that started it, on the same core, until its scheduler looks again some milliseconds later.

use rayweave_contract::{StrategyError, Tile, Work, render_tile};
use std::iter;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// The team's word that a member failed: leave the work as it is and return.
#[derive(Debug)]
pub struct Stop;

/// Threads that stop together: those that [`run`] starts, or a library's.
#[derive(Debug)]
pub struct Team {
    strategy: &'static str,
    stopped: AtomicBool,
    first_error: Mutex<Option<StrategyError>>,
}

/// Runs `body` on one thread for each of `shares`, all at the same time, and waits for them.
///
/// A share is what the thread alone works on: a range, slices of the picture, or nothing but a
/// reference to a queue that all of them take from.
///
/// # Errors
///
/// The first failure of any member: work that panicked, or a thread that could not be started.
/// The members that run are told to stop at their next tile, and are joined before this returns.
pub fn run<Share: Send>(
    strategy: &'static str,
    shares: impl ExactSizeIterator<Item = Share>,
    body: impl Fn(&Team, Share) -> Result<(), Stop> + Sync,
) -> Result<(), StrategyError> {
    run_beside(strategy, shares, body, || {})
}

/// As [`run`], while the caller's thread does `meanwhile`: it begins when all threads are started,
/// or have failed to, and has to end when they do.
///
/// # Errors
///
/// As [`run`].
pub fn run_beside<Share: Send>(
    strategy: &'static str,
    shares: impl ExactSizeIterator<Item = Share>,
    body: impl Fn(&Team, Share) -> Result<(), Stop> + Sync,
    meanwhile: impl FnOnce(),
) -> Result<(), StrategyError> {
    let threads = shares.len();
    let team = Team::new(strategy);
    let (team_ref, body) = (&team, &body);
    thread::scope(|scope| {
        for (index, share) in shares.enumerate() {
            let thread = thread::Builder::new().name(format!("{strategy} {index}"));
            // A member that returns `Stop` has nothing to add: the failure is with the team.
            if let Err(source) = thread.spawn_scoped(scope, move || drop(body(team_ref, share))) {
                team_ref.fail(StrategyError::Spawn { strategy, threads, source });
                break;
            }
        }
        meanwhile();
    });
    team.outcome()
}

/// Whether so many threads can be started at once, for libraries that would end the process or
/// panic where they cannot: starts them, and ends them when the last has begun.
///
/// # Errors
///
/// A thread that could not be started.
pub fn try_out(strategy: &'static str, threads: NonZeroUsize) -> Result<(), StrategyError> {
    let gate = Mutex::new(());
    let closed = gate.lock();
    let wait = |_: &Team, ()| {
        drop(gate.lock());
        Ok(())
    };
    run_beside(strategy, iter::repeat_n((), threads.get()), wait, || drop(closed))
}

/// Cuts `count` pieces into as many ranges as there are threads, equal but for one piece; empty
/// ones where there are more threads than pieces.
pub fn equal_shares(
    count: usize,
    threads: NonZeroUsize,
) -> impl ExactSizeIterator<Item = Range<usize>> {
    let threads = threads.get();
    (0..threads).map(move |share| count * share / threads..count * (share + 1) / threads)
}

impl Team {
    /// A team whose threads somebody else starts.
    #[must_use]
    pub fn new(strategy: &'static str) -> Self {
        Self { strategy, stopped: AtomicBool::new(false), first_error: Mutex::new(None) }
    }

    /// Renders one tile, unless the team has stopped.
    ///
    /// # Errors
    ///
    /// [`Stop`] when this work or another member's failed.
    pub fn render_tile(&self, work: &dyn Work, tile: &mut Tile<'_>) -> Result<(), Stop> {
        if self.stopped.load(Ordering::Relaxed) {
            return Err(Stop);
        }
        render_tile(self.strategy, work, tile).map_err(|error| self.fail(error))
    }

    /// What became of the work, once no thread is at it any more.
    ///
    /// # Errors
    ///
    /// The first failure of any member.
    pub fn outcome(self) -> Result<(), StrategyError> {
        let first_error = self.first_error.into_inner().unwrap_or_else(PoisonError::into_inner);
        first_error.map_or(Ok(()), Err)
    }

    fn fail(&self, error: StrategyError) -> Stop {
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
    fn shares_are_equal_but_for_one_piece_and_leave_nothing_out() {
        for (count, threads) in [(0, 3), (1, 1), (2, 5), (10, 3), (7, 7), (500, 64)] {
            let threads = NonZeroUsize::new(threads).expect("not 0");
            let shares: Vec<Range<usize>> = equal_shares(count, threads).collect();
            assert_eq!(shares.len(), threads.get());
            assert!(shares.iter().cloned().flatten().eq(0..count), "{shares:?}");
            let (least, most) = (count / threads, count.div_ceil(threads.get()));
            assert!(shares.iter().all(|share| (least..=most).contains(&share.len())), "{shares:?}");
        }
    }

    /// Catches a sender that outlives its thread: the receiver would wait for ever.
    #[test]
    fn the_caller_works_beside_the_team() {
        let (sender, receiver) = mpsc::channel();
        let mut received = Vec::new();
        let send = |_: &Team, (index, sender): (usize, mpsc::Sender<usize>)| {
            sender.send(index).map_err(|_| Stop)
        };
        let senders = iter::repeat_n(sender, 5).enumerate();
        run_beside("test", senders, send, || received.extend(receiver)).expect("the threads start");
        received.sort_unstable();
        assert_eq!(received, [0, 1, 2, 3, 4]);
    }

    /// Catches a caller that has a share: what it starts may wait behind it.
    #[test]
    fn the_caller_only_waits() {
        let (caller, ran) = (thread::current().id(), Mutex::new(Vec::new()));
        let note = |_: &Team, share: usize| {
            let by_caller = thread::current().id() == caller;
            ran.lock().unwrap_or_else(PoisonError::into_inner).push((share, by_caller));
            Ok(())
        };
        run("test", 0..5, note).expect("the threads start");
        let mut ran = ran.into_inner().expect("nobody panicked");
        ran.sort_unstable();
        assert!(ran.into_iter().eq((0..5).map(|share| (share, false))));
    }

    #[test]
    fn threads_are_tried_out_together() {
        try_out("test", NonZeroUsize::new(20).expect("not 0")).expect("20 threads start");
    }
}
