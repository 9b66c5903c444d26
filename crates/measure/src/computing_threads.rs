//! How many threads of a strategy really compute.
//!
//! Watching a rendering does not tell: a thread may be idle by the luck of scheduling alone, and on
//! a machine with two cores 64 threads hardly ever meet. So the work is a rendezvous: whoever
//! computes a tile waits until N distinct threads do. A strategy with N threads cannot help
//! bringing all of them, and one with fewer gives itself away by letting the time run out.

use crate::attempt::attempt;
use rayweave_core::image::ImageError;
use rayweave_core::{Image, Plan, Strategy, Tile, Work};
use std::collections::HashSet;
use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};
use thiserror::Error;

/// How long a rendezvous waits for threads before it gives up; only a strategy with too few waits it out.
pub const TIMEOUT: Duration = Duration::from_secs(10);

/// How long the threads that have met stay together, so that one too many comes to light.
const GRACE: Duration = Duration::from_millis(20);

/// Why threads could not be counted.
#[derive(Debug, Error)]
pub enum CountError {
    /// The strategy failed.
    #[error("{0}")]
    Strategy(String),
    /// So many threads that there is no picture with a tile for each.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// The number of threads that compute when `strategy` is prepared for `threads` of them.
///
/// Too few are reported after `timeout`, exactly; so are too many, unless the surplus thread is not
/// scheduled at all while the others wait for it some 20 ms.
///
/// # Errors
///
/// The strategy failed, or there is no picture with enough tiles.
pub fn computing_threads(
    strategy: &dyn Strategy,
    threads: NonZeroUsize,
    timeout: Duration,
) -> Result<usize, CountError> {
    // Enough pixels, rows and columns that each thread gets some, whatever it is that a strategy
    // deals out, and that something is left over for a surplus thread.
    let side = u32::try_from(threads.get()).unwrap_or(u32::MAX).saturating_mul(4);
    let mut image = Image::new(side, side)?;
    let rendezvous = Rendezvous::new(threads.get(), timeout);
    let plan = Plan { threads, tile: NonZeroU32::MIN };
    attempt(|| strategy.prepare(plan)?.render(&rendezvous, &mut image)).map_err(CountError::Strategy)?;
    Ok(rendezvous.threads())
}

/// A work that returns from its first tiles only when enough distinct threads compute one.
#[derive(Debug)]
struct Rendezvous {
    threads: usize,
    timeout: Duration,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug)]
struct State {
    seen: HashSet<ThreadId>,
    phase: Phase,
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    /// Nobody has come yet.
    Empty,
    /// Threads wait for more of them, until then at most.
    Gathering(Instant),
    /// All have met, and wait until then for one too many.
    Complete(Instant),
    /// Nobody waits any more.
    Open,
}

impl Rendezvous {
    fn new(threads: usize, timeout: Duration) -> Self {
        let state = Mutex::new(State { seen: HashSet::new(), phase: Phase::Empty });
        Self { threads, timeout, state, changed: Condvar::new() }
    }

    fn threads(self) -> usize {
        self.state.into_inner().unwrap_or_else(PoisonError::into_inner).seen.len()
    }
}

impl Work for Rendezvous {
    fn render(&self, tile: &mut Tile<'_>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.seen.insert(thread::current().id());
        if let Phase::Empty = state.phase {
            state.phase = Phase::Gathering(Instant::now() + self.timeout);
        }
        if let Phase::Gathering(_) = state.phase
            && state.seen.len() >= self.threads
        {
            state.phase = Phase::Complete(Instant::now() + GRACE);
            self.changed.notify_all();
        }
        while let Phase::Gathering(end) | Phase::Complete(end) = state.phase {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                state.phase = Phase::Open;
                self.changed.notify_all();
            } else {
                let waited = self.changed.wait_timeout(state, left);
                state = waited.unwrap_or_else(PoisonError::into_inner).0;
            }
        }
        drop(state);
        tile.rows().for_each(|(_, row)| row.fill([0.0; 3]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is counted when `present` threads compute and `asked` are waited for.
    fn count(present: usize, asked: usize, timeout: Duration) -> usize {
        let rendezvous = Rendezvous::new(asked, timeout);
        thread::scope(|scope| {
            for _ in 0..present {
                scope
                    .spawn(|| (0..10).for_each(|x| rendezvous.render(&mut Tile::pixel(x, 0, &mut [1.0; 3]))));
            }
        });
        rendezvous.threads()
    }

    #[test]
    fn as_many_as_there_are() {
        for threads in [1, 2, 64] {
            assert_eq!(count(threads, threads, TIMEOUT), threads);
        }
        assert_eq!(count(4, 3, TIMEOUT), 4, "too many");
        for (present, asked) in [(1, 2), (3, 5)] {
            assert_eq!(count(present, asked, Duration::from_millis(50)), present, "too few");
        }
    }
}
