//! Observers around a work: a recorder of the tiles and their threads, and a counter of rays.

use rayweave_contract::{Rect, Tile, Work};
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, ThreadId};

/// Records every tile that the inner work completes, and its thread.
///
/// It takes a lock and keeps an entry for each tile. Use it for checks, not for timed runs.
pub struct Recorder<'a> {
    work: &'a dyn Work,
    log: Mutex<Log>,
}

#[derive(Debug, Default)]
struct Log {
    threads: Vec<(ThreadId, ComputingThread)>,
    computations: Vec<(Rect, usize)>,
}

/// A thread that computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComputingThread {
    /// 0 for the first thread to complete a tile, 1 for the next other one, and so on.
    pub index: usize,
    /// Its name, where it has one.
    pub name: Option<String>,
}

/// The computation of a tile by a thread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Computation {
    /// The tile that the work was called with; a single pixel for a strategy with that granularity.
    pub tile: Rect,
    /// The thread that computed it.
    pub thread: ComputingThread,
}

/// The computations of one rendering, recorded by a [`Recorder`].
#[derive(Debug)]
pub struct TileRecord {
    log: Log,
}

impl<'a> Recorder<'a> {
    /// Returns a recorder around `work`.
    #[must_use]
    pub fn new(work: &'a dyn Work) -> Self {
        Self { work, log: Mutex::default() }
    }

    /// Returns the record.
    #[must_use]
    pub fn finish(self) -> TileRecord {
        TileRecord { log: self.log.into_inner().unwrap_or_else(PoisonError::into_inner) }
    }
}

impl Work for Recorder<'_> {
    fn render(&self, tile: &mut Tile<'_>) {
        self.work.render(tile);
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        let thread = log.index_of_this_thread();
        log.computations.push((tile.rect(), thread));
    }
}

impl Log {
    fn index_of_this_thread(&mut self) -> usize {
        let this = thread::current();
        let known = self.threads.iter().position(|(id, _)| *id == this.id());
        known.unwrap_or_else(|| {
            let index = self.threads.len();
            self.threads
                .push((this.id(), ComputingThread { index, name: this.name().map(str::to_owned) }));
            index
        })
    }
}

impl TileRecord {
    /// Returns the number of threads that computed.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.log.threads.len()
    }

    /// Returns the computations of pixel `(x, y)`, in the order of completion.
    #[must_use]
    pub fn of_pixel(&self, x: u32, y: u32) -> Vec<Computation> {
        let containing = self.log.computations.iter().filter(|(tile, _)| tile.contains(x, y));
        containing.map(|&(tile, thread)| self.computation(tile, thread)).collect()
    }

    /// Returns the number of computations of each pixel of an image of this size, row by row.
    /// Pixels outside of the image are not counted.
    #[must_use]
    pub fn times_computed(&self, width: u32, height: u32) -> Vec<u32> {
        let mut times = vec![0; width as usize * height as usize];
        for (tile, _) in &self.log.computations {
            let columns =
                tile.x.min(width) as usize..tile.x.saturating_add(tile.width).min(width) as usize;
            for y in tile.y..tile.y.saturating_add(tile.height).min(height) {
                let row = &mut times[y as usize * width as usize..][..width as usize];
                row[columns.clone()].iter_mut().for_each(|count| *count += 1);
            }
        }
        times
    }

    fn computation(&self, tile: Rect, thread: usize) -> Computation {
        Computation { tile, thread: self.log.threads[thread].1.clone() }
    }
}

/// A function that returns the number of primary rays of a tile, or of their packets; `None` if it
/// is unknown.
pub type RayCost<'a> = dyn Fn(Rect) -> Option<u64> + Sync + 'a;

/// Adds up the primary rays, or the packets, of all tiles that the inner work completes. The
/// addition costs little, but do not use it for timed runs.
pub struct RayCounter<'a> {
    work: &'a dyn Work,
    cost: &'a RayCost<'a>,
    sum: AtomicU64,
    /// True if the rays of a tile were unknown.
    unknown: AtomicBool,
}

impl<'a> RayCounter<'a> {
    /// Returns a counter around `work`.
    #[must_use]
    pub fn new(work: &'a dyn Work, cost: &'a RayCost<'a>) -> Self {
        Self { work, cost, sum: AtomicU64::new(0), unknown: AtomicBool::new(false) }
    }

    /// Returns the sum, or `None` if the number of a tile was unknown.
    #[must_use]
    pub fn finish(self) -> Option<u64> {
        (!self.unknown.into_inner()).then_some(self.sum.into_inner())
    }
}

impl Work for RayCounter<'_> {
    fn render(&self, tile: &mut Tile<'_>) {
        self.work.render(tile);
        match (self.cost)(tile.rect()) {
            Some(cost) => drop(self.sum.fetch_add(cost, Ordering::Relaxed)),
            None => self.unknown.store(true, Ordering::Relaxed),
        }
    }
}

impl fmt::Debug for RayCounter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RayCounter").field("sum", &self.sum).finish_non_exhaustive()
    }
}

impl fmt::Debug for Recorder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder").field("log", &self.log).finish_non_exhaustive()
    }
}

impl fmt::Display for ComputingThread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "thread {}", self.index)?;
        self.name.as_ref().map_or(Ok(()), |name| write!(f, " (\"{name}\")"))
    }
}

impl fmt::Display for Computation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tile {} by {}", self.tile, self.thread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fakes::Grey;

    #[test]
    fn tiles_threads_and_pixels() {
        let recorder = Recorder::new(&Grey);
        let render = |x, y| recorder.render(&mut Tile::row(x, y, &mut [[1.0; 3]; 2]));
        render(0, 0);
        thread::scope(|scope| {
            let named = thread::Builder::new().name("second".to_owned());
            named.spawn_scoped(scope, || render(1, 0)).expect("a thread");
        });
        render(2, 1);
        let record = recorder.finish();

        assert_eq!(record.threads(), 2);
        let order: Vec<_> =
            record.of_pixel(1, 0).iter().map(|c| (c.tile.x, c.thread.index)).collect();
        assert_eq!(order, [(0, 0), (1, 1)]);
        assert_eq!(record.of_pixel(2, 1)[0].thread.index, 0);
        // The row at (2, 1) reaches beyond an image of 3 x 2.
        assert_eq!(record.times_computed(3, 2), [1, 2, 1, 0, 0, 1]);
        let last = record.of_pixel(1, 0).pop().expect("computed");
        assert_eq!(last.to_string(), "tile 2x1 at (1, 0) by thread 1 (\"second\")");
        assert_eq!(record.of_pixel(0, 1), []);
    }

    /// Catches a tile that is not counted, or counted by another rectangle than its own.
    #[test]
    fn rays_of_all_threads_add_up() {
        let cost =
            |rect: Rect| (rect.x < 4).then(|| u64::from(100 * rect.x + 10 * rect.y + rect.width));
        let counter = RayCounter::new(&Grey, &cost);
        counter.render(&mut Tile::pixel(3, 2, &mut [1.0; 3]));
        thread::scope(|scope| {
            for y in 0..2 {
                let counter = &counter;
                scope.spawn(move || counter.render(&mut Tile::row(1, y, &mut [[1.0; 3]; 5])));
            }
        });
        assert_eq!(counter.finish(), Some(321 + 105 + 115));

        let counter = RayCounter::new(&Grey, &cost);
        [3, 4, 3].into_iter().for_each(|x| counter.render(&mut Tile::pixel(x, 2, &mut [1.0; 3])));
        assert_eq!(counter.finish(), None);
    }
}
