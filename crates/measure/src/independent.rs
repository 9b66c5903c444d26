//! What cores cost each other: threads that share nothing, each of which draws the whole picture.

use crate::statistics::{Interval, median_ratio_interval};
use rayweave_core::strategy::{Dealing, Delivery, Piece, Rule, panic_message, render_tile};
use rayweave_core::{Image, Plan, Renderer, Strategy, StrategyError, ThreadsStart, Work};
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

const NAME: &str = "independent";

/// No way to share work: with N threads the picture is drawn N times. How much longer that takes than once is what the
/// machine's cores cost each other.
#[derive(Debug, Default)]
pub struct Independent {
    shared: Arc<Mutex<Shared>>,
}

/// What one rendering leaves to the next.
#[derive(Debug, Default)]
struct Shared {
    /// Of each thread but the first: no rendering but the first pays for fresh memory.
    copies: Vec<Image>,
    /// Of each rendering, how long a thread drew, in nanoseconds, in the mean.
    thread_ns: Vec<f64>,
}

impl Independent {
    /// How many times as long as alone, `alone_ns` nanoseconds, a thread drew beside the others; `None` before any
    /// rendering. Of each rendering the mean of its threads counts, not the last: where work is shared, whoever is not
    /// disturbed does more of it.
    #[must_use]
    pub fn slowdown(&self, alone_ns: &[u64]) -> Option<Interval> {
        let alone: Vec<f64> = alone_ns.iter().map(|&ns| ns as f64).collect();
        median_ratio_interval(&self.shared.lock().unwrap_or_else(PoisonError::into_inner).thread_ns, &alone)
    }
}

impl Strategy for Independent {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "each thread draws the whole picture: what cores cost each other"
    }

    fn threads_start(&self) -> ThreadsStart {
        ThreadsStart::Render
    }

    fn rule(&self) -> Rule {
        Rule { piece: Piece::Tile, dealing: Dealing::Equal, delivery: Delivery::InPlace }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(Copying { plan, shared: Arc::clone(&self.shared) }))
    }
}

struct Copying {
    plan: Plan,
    shared: Arc<Mutex<Shared>>,
}

impl Renderer for Copying {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let threads = self.plan.threads.get();
        let cannot_start = |source| StrategyError::Spawn { strategy: NAME, threads, source };
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let Shared { copies, thread_ns } = &mut *shared;
        copies.retain(|copy| (copy.width(), copy.height()) == (image.width(), image.height()));
        while copies.len() < threads - 1 {
            let copy = Image::new(image.width(), image.height());
            copies.push(copy.map_err(|e| cannot_start(io::Error::other(e)))?);
        }
        let draw = |image: &mut Image| {
            let begin = Instant::now();
            image.tiles(self.plan.tile).iter_mut().try_for_each(|tile| render_tile(NAME, work, tile))?;
            Ok(begin.elapsed())
        };
        let sum = thread::scope(|scope| {
            let others = copies[..threads - 1].iter_mut().map(|copy| {
                let thread = thread::Builder::new().name(NAME.to_owned());
                thread.spawn_scoped(scope, || draw(copy)).map_err(cannot_start)
            });
            let others = others.collect::<Result<Vec<_>, _>>()?;
            let mut sum: Duration = draw(image)?;
            for other in others {
                sum += other
                    .join()
                    .map_err(|payload| cannot_start(io::Error::other(panic_message(&*payload))))??;
            }
            Ok(sum)
        })?;
        thread_ns.push(sum.as_nanos() as f64 / threads as f64);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recorder::Recorder;
    use crate::synthetic::even;
    use std::num::{NonZeroU32, NonZeroUsize};

    /// Catches threads that share the work, and a picture of another size that is drawn into an old copy.
    #[test]
    fn each_thread_draws_all_of_it() {
        let (threads, tile) = (NonZeroUsize::new(3).expect("not 0"), NonZeroU32::new(2).expect("not 0"));
        let mut renderer = Independent::default().prepare(Plan { threads, tile }).expect("prepared");
        for (width, height) in [(5, 4), (2, 7)] {
            let work = even(1);
            let recorder = Recorder::new(&work);
            renderer.render(&recorder, &mut Image::new(width, height).expect("a picture")).expect("drawn");
            let record = recorder.finish();
            assert_eq!(record.threads(), 3);
            assert!(record.times_computed(width, height).iter().all(|times| *times == 3));
        }
    }

    /// Catches a time that is the sum of the threads' or that of the last: one draws 3 ns, the other 9.
    #[test]
    fn a_thread_is_slowed_down_by_the_mean() {
        let independent = Independent::default();
        assert_eq!(independent.slowdown(&[4]), None);
        let threads = NonZeroUsize::new(2).expect("not 0");
        let mut renderer = independent.prepare(Plan { threads, tile: NonZeroU32::MIN }).expect("prepared");
        let begin = Instant::now();
        renderer.render(&even(20_000), &mut Image::new(16, 16).expect("a picture")).expect("drawn");
        let wall = begin.elapsed().as_nanos() as u64;
        let slowdown = independent.slowdown(&[wall]).expect("rendered").median;
        assert!(slowdown > 0.0 && slowdown <= 1.0, "{slowdown}");
    }
}
