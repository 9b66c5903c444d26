//! Counts the threads of a strategy that compute at the same time.
//!
//! Observing an ordinary rendering is not enough: a thread may be idle by chance, and on two cores
//! 64 threads hardly ever run together. So the work is a rendezvous: each tile waits until N
//! distinct threads compute one. A strategy with N threads brings all of them. With fewer, or with
//! a lock that only one thread at a time computes under, the time runs out. A thread that comes
//! after that is not counted, because it may have been started when another had ended.

use crate::catch_panic::catch_panic;
use rayweave_contract::{Image, ImageError, Plan, Strategy, Tile, Work};
use std::collections::HashSet;
use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};
use thiserror::Error;

/// The time that a rendezvous waits for the next thread. Only a strategy with too few threads takes
/// it. It begins anew with each thread that comes, so a slow machine may start a thousand.
pub const TIMEOUT: Duration = Duration::from_secs(1);

/// The time that threads wait for a surplus thread after all have met.
const GRACE: Duration = Duration::from_millis(20);

/// The largest number of pixels of a rendezvous, unless two for each thread are more: 12 MiB.
const MAX_PIXELS: u32 = 1 << 20;

/// An error that prevents counting threads.
#[derive(Debug, Error)]
pub enum CountError {
    /// The strategy failed.
    #[error("{0}")]
    Strategy(String),
    /// There are so many threads that no image has a tile for each.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// The image that the threads of a plan meet over: a column of two tiles for each.
///
/// Each thread gets some, and a surplus thread too, whether the pieces are pixels, rows or tiles. A
/// strategy whose pieces are columns would need another image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rendezvous {
    /// The plan, with smaller tiles where the image would be too large.
    pub plan: Plan,
    /// The width of the image in pixels: a tile's, or less where the image would be too large.
    pub width: u32,
    /// The height of the image in pixels.
    pub height: u32,
}

impl Rendezvous {
    /// Returns the rendezvous for the threads of `plan`.
    #[must_use]
    pub fn of(plan: Plan) -> Self {
        let tiles = u32::try_from(plan.threads.get()).unwrap_or(u32::MAX).saturating_mul(2);
        let largest = NonZeroU32::new(MAX_PIXELS / tiles).unwrap_or(NonZeroU32::MIN);
        let tile = plan.tile.min(largest);
        let height = tile.get().saturating_mul(tiles);
        let width = (MAX_PIXELS / height).clamp(1, tile.get());
        Self { plan: Plan { tile, ..plan }, width, height }
    }

    /// Returns the number of threads that compute when `strategy` is prepared for the plan.
    ///
    /// Too few are counted exactly, when no other has come for `timeout`. If there are too many, at
    /// least one of them is counted, unless the operating system does not schedule it for the 20 ms
    /// that the others wait for it.
    ///
    /// # Errors
    ///
    /// The strategy failed, or there is no image with enough tiles.
    pub fn computing_threads(
        &self,
        strategy: Strategy<'_>,
        timeout: Duration,
    ) -> Result<usize, CountError> {
        let mut image = Image::new(self.width, self.height)?;
        let meeting = RendezvousWork::new(self.plan.threads, timeout);
        catch_panic(|| strategy.prepare(self.plan)?.render(&meeting, &mut image))
            .map_err(CountError::Strategy)?;
        Ok(meeting.threads())
    }
}

/// A work that returns from its first tiles only when enough distinct threads compute one each.
#[derive(Debug)]
struct RendezvousWork {
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
    /// Threads wait for the next one, until this time.
    Gathering(Instant),
    /// All threads have met, and wait for a surplus one until this time.
    Complete(Instant),
    /// All threads have met and wait no more; any other thread is a surplus one.
    Open,
    /// Too few threads came in time, and those that did wait no more; others are not counted.
    GivenUp,
}

impl RendezvousWork {
    fn new(threads: NonZeroUsize, timeout: Duration) -> Self {
        // The first thread to come sets the time.
        let phase = Phase::Gathering(Instant::now());
        let state = Mutex::new(State { seen: HashSet::new(), phase });
        Self { threads: threads.get(), timeout, state, changed: Condvar::new() }
    }

    fn threads(self) -> usize {
        self.state.into_inner().unwrap_or_else(PoisonError::into_inner).seen.len()
    }
}

impl Work for RendezvousWork {
    fn render(&self, tile: &mut Tile<'_>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let is_new =
            !matches!(state.phase, Phase::GivenUp) && state.seen.insert(thread::current().id());
        if is_new && matches!(state.phase, Phase::Gathering(_)) {
            if state.seen.len() >= self.threads {
                state.phase = Phase::Complete(Instant::now() + GRACE);
                self.changed.notify_all();
            } else {
                state.phase = Phase::Gathering(Instant::now() + self.timeout);
            }
        }
        while let Phase::Gathering(end) | Phase::Complete(end) = state.phase {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                let met = matches!(state.phase, Phase::Complete(_));
                state.phase = if met { Phase::Open } else { Phase::GivenUp };
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

    /// Returns the count when `present` threads compute and `asked` are waited for.
    fn count(present: usize, asked: usize, timeout: Duration) -> usize {
        let meeting = meeting_of(asked, timeout);
        thread::scope(|scope| {
            for _ in 0..present {
                scope.spawn(|| compute(&meeting));
            }
        });
        meeting.threads()
    }

    fn meeting_of(threads: usize, timeout: Duration) -> RendezvousWork {
        RendezvousWork::new(NonZeroUsize::new(threads).expect("not 0"), timeout)
    }

    fn compute(meeting: &RendezvousWork) {
        (0..10).for_each(|x| meeting.render(&mut Tile::pixel(x, 0, &mut [1.0; 3])));
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

    /// Catches a wait that a slow machine could not start many threads in.
    #[test]
    fn each_thread_that_comes_is_given_the_whole_time() {
        let (meeting, pause) = (meeting_of(5, Duration::from_secs(2)), Duration::from_millis(600));
        thread::scope(|scope| {
            for _ in 0..5 {
                scope.spawn(|| compute(&meeting));
                thread::sleep(pause);
            }
        });
        assert_eq!(meeting.threads(), 5);
    }

    /// Catches threads that run one after the other counted as several.
    #[test]
    fn a_late_thread_counts_only_if_all_had_met() {
        let one_after_another = |threads: usize, asked| {
            let meeting = meeting_of(asked, Duration::from_millis(20));
            for _ in 0..threads {
                thread::scope(|scope| drop(scope.spawn(|| compute(&meeting)).join()));
            }
            meeting.threads()
        };
        assert_eq!(one_after_another(2, 2), 1);
        assert_eq!(one_after_another(3, 1), 3);
    }

    #[test]
    fn two_tiles_for_each_thread_within_bounds() {
        for threads in [1, 2, 64, 1024] {
            for tile in [1, 8, 32, 1000, u32::MAX] {
                let plan = Plan {
                    threads: NonZeroUsize::new(threads).expect("not 0"),
                    tile: NonZeroU32::new(tile).expect("not 0"),
                };
                let Rendezvous { plan: Plan { tile: side, .. }, width, height } =
                    Rendezvous::of(plan);
                let mut image = Image::new(width, height).expect("an image");
                assert_eq!(image.tiles(side).len(), 2 * threads, "{plan:?}");
                assert!(width * height <= MAX_PIXELS, "{plan:?}: {width} x {height}");
                assert!(side.get() == tile || tile >= 1000, "{plan:?}: {side}");
            }
        }
    }
}
