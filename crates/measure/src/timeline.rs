//! Records the begin and end of every piece on every thread: an observer around a work.
//!
//! Each thread writes to its own memory, which is allocated before the rendering begins. Recording
//! a piece then costs two clock readings and a few stores; [`RecordingCost::here`] measures it.

mod cost;

pub use cost::RecordingCost;

use rayweave_contract::{Rect, Tile, Work};
use std::cell::RefCell;
use std::fmt;
use std::mem;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, ThreadId};
use std::time::Instant;

/// The pieces of one rendering, by thread.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timeline {
    /// The time of the rendering, in nanoseconds.
    pub wall_ns: u64,
    /// The lanes, one for each thread that computed, in the order of their first pieces.
    pub lanes: Vec<TimelineLane>,
}

/// The pieces of one thread.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimelineLane {
    /// The thread's name, where it has one.
    pub name: Option<String>,
    /// The pieces in order of time. There is at least one, and no two overlap.
    pub pieces: Vec<Piece>,
}

/// A tile that the work was called with; a single pixel for a strategy with that granularity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The rectangle of its pixels.
    pub rect: Rect,
    /// The time of its begin, in nanoseconds since the rendering began.
    pub begin_ns: u64,
    /// The time of its end, in nanoseconds since the rendering began.
    pub end_ns: u64,
}

impl Timeline {
    /// Returns the number of pieces of all threads.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.lanes.iter().map(|lane| lane.pieces.len()).sum()
    }
}

impl TimelineLane {
    /// Returns the time spent on pieces, in nanoseconds.
    #[must_use]
    pub fn busy_ns(&self) -> u64 {
        self.pieces.iter().map(Piece::ns).sum()
    }

    /// Returns the time between each piece and the next, in nanoseconds.
    pub fn gaps_ns(&self) -> impl Iterator<Item = u64> {
        self.pieces.windows(2).map(|pair| pair[1].begin_ns.saturating_sub(pair[0].end_ns))
    }

    /// Returns the number of pixels of all pieces.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.pieces
            .iter()
            .map(|piece| u64::from(piece.rect.width) * u64::from(piece.rect.height))
            .sum()
    }
}

impl Piece {
    /// Returns the time of the piece, in nanoseconds.
    #[must_use]
    pub fn ns(&self) -> u64 {
        self.end_ns.saturating_sub(self.begin_ns)
    }
}

/// Records the begin, the end and the thread of every tile of one rendering of the inner work.
pub struct TimeRecorder<'a> {
    work: &'a dyn Work,
    origin: Instant,
    /// A number unique in this process. A thread compares it to find out whether the lane that it
    /// remembers belongs to this recorder.
    number: u64,
    lanes: Mutex<Lanes>,
}

/// The lanes in use and the free ones. A thread locks them at its first tile only.
struct Lanes {
    taken: Vec<(ThreadId, Option<String>, Arc<Pieces>)>,
    /// Lanes with reserved memory, for threads to come.
    free: Vec<Arc<Pieces>>,
}

/// The pieces of a thread. Only that thread locks them during a rendering, so the lock is
/// uncontended.
type Pieces = Mutex<Vec<Piece>>;

static RECORDERS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    /// The recorder that this thread last computed for, and its lane there.
    static LATEST: RefCell<Option<(u64, Arc<Pieces>)>> = const { RefCell::new(None) };
}

impl<'a> TimeRecorder<'a> {
    /// Returns a recorder for a rendering of `work`, with memory for `pieces` pieces on each of
    /// `threads` threads. It allocates while recording if there are more of either.
    #[must_use]
    pub fn new(work: &'a dyn Work, threads: usize, pieces: usize) -> Self {
        let untouched =
            Piece { rect: Rect { x: 0, y: 0, width: 0, height: 0 }, begin_ns: 0, end_ns: 0 };
        let room = || {
            // Write to the memory once: the operating system maps a page at the first access.
            let mut pieces = vec![untouched; pieces];
            pieces.clear();
            Arc::new(Mutex::new(pieces))
        };
        Self {
            work,
            origin: Instant::now(),
            number: RECORDERS.fetch_add(1, Ordering::Relaxed),
            lanes: Mutex::new(Lanes {
                taken: Vec::new(),
                free: (0..threads).map(|_| room()).collect(),
            }),
        }
    }

    /// Returns the time line of the rendering that began at `begin` and ended at `end`.
    #[must_use]
    pub fn finish(self, begin: Instant, end: Instant) -> Timeline {
        let before = self.nanoseconds(begin);
        let lanes = self.lanes.into_inner().unwrap_or_else(PoisonError::into_inner);
        let lane = |(_, name, pieces): (_, _, Arc<Pieces>)| {
            // Pooled threads live on and remember the lane, so take the contents out of it.
            let mut pieces = mem::take(&mut *pieces.lock().unwrap_or_else(PoisonError::into_inner));
            for piece in &mut pieces {
                piece.begin_ns = piece.begin_ns.saturating_sub(before);
                piece.end_ns = piece.end_ns.saturating_sub(before);
            }
            pieces.shrink_to_fit();
            TimelineLane { name, pieces }
        };
        let mut lanes: Vec<TimelineLane> = lanes.taken.into_iter().map(lane).collect();
        lanes.sort_by_key(|lane| lane.pieces.first().map(|piece| piece.begin_ns));
        Timeline { wall_ns: nanoseconds_between(begin, end), lanes }
    }

    fn nanoseconds(&self, at: Instant) -> u64 {
        nanoseconds_between(self.origin, at)
    }

    fn lane_of_this_thread(&self) -> Arc<Pieces> {
        let mut lanes = self.lanes.lock().unwrap_or_else(PoisonError::into_inner);
        let this = thread::current();
        if let Some((_, _, known)) = lanes.taken.iter().find(|(id, ..)| *id == this.id()) {
            return known.clone();
        }
        let lane = lanes.free.pop().unwrap_or_default();
        lanes.taken.push((this.id(), this.name().map(str::to_owned), lane.clone()));
        lane
    }
}

impl Work for TimeRecorder<'_> {
    fn render(&self, tile: &mut Tile<'_>) {
        let begin = Instant::now();
        self.work.render(tile);
        let end = Instant::now();
        let (begin_ns, end_ns) = (self.nanoseconds(begin), self.nanoseconds(end));
        let piece = Piece { rect: tile.rect(), begin_ns, end_ns };
        LATEST.with_borrow_mut(|latest| {
            let (_, lane) = match latest {
                Some(latest) if latest.0 == self.number => latest,
                _ => latest.insert((self.number, self.lane_of_this_thread())),
            };
            lane.lock().unwrap_or_else(PoisonError::into_inner).push(piece);
        });
    }
}

impl fmt::Debug for TimeRecorder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TimeRecorder").field("number", &self.number).finish_non_exhaustive()
    }
}

/// Returns the nanoseconds from `begin` to `end`; 0 if `end` is earlier. A `u64` of nanoseconds
/// lasts for 584 years.
fn nanoseconds_between(begin: Instant, end: Instant) -> u64 {
    let duration = end.saturating_duration_since(begin);
    duration.as_secs() * 1_000_000_000 + u64::from(duration.subsec_nanos())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    struct Sleep;

    impl Work for Sleep {
        fn render(&self, _: &mut Tile<'_>) {
            thread::sleep(Duration::from_micros(10));
        }
    }

    fn render(recorder: &TimeRecorder<'_>, x: u32) {
        recorder.render(&mut Tile::row(x, 1, &mut [[1.0; 3]; 2]));
    }

    /// Catches a lane with pieces of another thread, an end before the work's, and times that are
    /// not since the rendering's begin.
    #[test]
    fn each_thread_has_its_pieces_in_order() {
        let recorder = TimeRecorder::new(&Sleep, 1, 1);
        thread::sleep(Duration::from_millis(2));
        let begin = Instant::now();
        render(&recorder, 0);
        thread::scope(|scope| {
            let named = thread::Builder::new().name("second".to_owned());
            let run = || (10..13).for_each(|x| render(&recorder, x));
            named.spawn_scoped(scope, run).expect("a thread").join().expect("no panic");
        });
        render(&recorder, 1);
        let timeline = recorder.finish(begin, Instant::now());

        let areas =
            |lane: &TimelineLane| lane.pieces.iter().map(|piece| piece.rect.x).collect::<Vec<_>>();
        let [first, second] = &timeline.lanes[..] else { panic!("{timeline:?}") };
        assert_eq!((areas(first), areas(second)), (vec![0, 1], vec![10, 11, 12]));
        assert_eq!(second.name.as_deref(), Some("second"));
        assert_eq!((timeline.pieces(), first.pixels(), second.pixels()), (5, 4, 6));
        let mut all: Vec<Piece> = [&second.pieces[..], &[first.pieces[1]]].concat();
        all.insert(0, first.pieces[0]);
        assert!(all.iter().all(|piece| piece.ns() >= 10_000), "{all:?}");
        assert!(all.windows(2).all(|pair| pair[0].end_ns <= pair[1].begin_ns), "{all:?}");
        assert!(all[4].end_ns <= timeline.wall_ns, "{timeline:?}");
    }

    /// Catches a thread that goes on writing to the lane of an earlier recorder, or that gets a
    /// second one when it comes back to the first.
    #[test]
    fn a_thread_may_compute_for_two_recorders_in_turn() {
        let recorders = [0, 1].map(|_| TimeRecorder::new(&Sleep, 1, 0));
        let begin = Instant::now();
        (0..5).for_each(|x| render(&recorders[x as usize % 2], x));
        let lanes = recorders.map(|recorder| recorder.finish(begin, Instant::now()).lanes);
        let counts =
            lanes.map(|lanes| lanes.iter().map(|lane| lane.pieces.len()).collect::<Vec<_>>());
        assert_eq!(counts, [[3], [2]]);
    }

    #[test]
    fn times_of_a_lane() {
        let piece = |begin_ns, end_ns| Piece {
            rect: Rect { x: 0, y: 0, width: 3, height: 2 },
            begin_ns,
            end_ns,
        };
        let lane =
            TimelineLane { name: None, pieces: vec![piece(5, 8), piece(9, 20), piece(24, 25)] };
        assert_eq!((lane.busy_ns(), lane.pixels()), (15, 18));
        assert_eq!(lane.gaps_ns().collect::<Vec<_>>(), [1, 4]);
    }
}
