//! Measures how much cores slow each other down: threads that share nothing render the whole image
//! each.

use crate::in_process::nanoseconds;
use crate::statistics::{Interval, ratio_interval};
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Prepare, RenderError, Scheduling, Strategy, Threads,
    Work, panic_message, render_tile, renderer,
};
use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// A strategy that does not share work: N threads render the image N times. Its time over that of
/// one rendering is the slowdown by other cores.
pub struct Independent {
    shared: Arc<Mutex<Shared>>,
    prepare: Box<Prepare<'static>>,
}

/// The state that one rendering leaves to the next.
#[derive(Debug, Default)]
struct Shared {
    /// The images of all threads but the first. They are kept, so that only the first rendering
    /// pays for fresh memory.
    copies: Vec<Image>,
    /// The mean nanoseconds of a thread in each rendering, by the number of threads.
    thread_ns: BTreeMap<usize, Vec<u64>>,
}

impl Default for Independent {
    /// Returns a strategy without a measurement yet.
    fn default() -> Self {
        let shared = Arc::<Mutex<Shared>>::default();
        let kept = Arc::clone(&shared);
        let prepare = move |plan| {
            let shared = Arc::clone(&kept);
            renderer(move |work, image| render(plan, &shared, work, image))
        };
        Self { shared, prepare: Box::new(prepare) }
    }
}

impl Independent {
    /// Returns the strategy, an entry of a comparison.
    #[must_use]
    pub fn strategy(&self) -> Strategy<'_> {
        Strategy {
            name: "independent",
            summary: "each thread renders the whole image: how much cores slow each other down",
            threads: Threads::PerRender,
            policy: Policy::new(Granularity::Tile, Scheduling::Static, Output::InPlace),
            unavailable: None,
            prepare: &*self.prepare,
        }
    }

    /// Returns the time of a thread beside others, `threads` in all, over the times alone,
    /// `alone_ns` in nanoseconds, round by round. The latest renderings are used, as many as there
    /// are times alone. `None` if there are none.
    ///
    /// The time of a rendering is the mean of its threads, not that of the last: where work is
    /// shared, undisturbed threads do more of it.
    #[must_use]
    pub fn slowdown(&self, threads: usize, alone_ns: &[u64]) -> Option<Interval> {
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let times = shared.thread_ns.get(&threads)?;
        // The first ones are those of the warm-up.
        ratio_interval(&times[times.len().saturating_sub(alone_ns.len())..], alone_ns)
    }
}

fn render(
    plan: Plan,
    shared: &Mutex<Shared>,
    work: &dyn Work,
    image: &mut Image,
) -> Result<(), RenderError> {
    let threads = plan.threads.get();
    let cannot_start = |source| RenderError::Spawn { threads, source };
    let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
    let Shared { copies, thread_ns } = &mut *shared;
    copies.retain(|copy| (copy.width(), copy.height()) == (image.width(), image.height()));
    while copies.len() < threads - 1 {
        let copy = Image::new(image.width(), image.height());
        copies.push(copy.map_err(|e| cannot_start(io::Error::other(e)))?);
    }
    let draw = |image: &mut Image| {
        let begin = Instant::now();
        image.tiles(plan.tile).iter_mut().try_for_each(|tile| render_tile(work, tile))?;
        Ok(begin.elapsed())
    };
    let drawn =
        thread::scope(|scope| {
            let others = copies[..threads - 1].iter_mut().map(|copy| {
                thread::Builder::new().spawn_scoped(scope, || draw(copy)).map_err(cannot_start)
            });
            let others = others.collect::<Result<Vec<_>, _>>()?;
            let mut drawn = vec![draw(image)?];
            for other in others {
                let joined = other.join();
                drawn.push(joined.map_err(|payload| {
                    cannot_start(io::Error::other(panic_message(&*payload)))
                })??);
            }
            Ok(drawn)
        })?;
    thread_ns.entry(threads).or_default().push(mean_ns(&drawn));
    Ok(())
}

/// Returns the mean of `times` in nanoseconds; 0 if there are none.
fn mean_ns(times: &[Duration]) -> u64 {
    nanoseconds(times.iter().sum()) / times.len().max(1) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recorder::Recorder;
    use crate::synthetic::even;
    use std::num::{NonZeroU32, NonZeroUsize};

    /// Catches threads that share the work, and an image of another size rendered into an old copy.
    #[test]
    fn each_thread_renders_the_whole_image() {
        let (threads, tile) =
            (NonZeroUsize::new(3).expect("not 0"), NonZeroU32::new(2).expect("not 0"));
        let mut renderer =
            Independent::default().strategy().prepare(Plan { threads, tile }).expect("prepared");
        for (width, height) in [(5, 4), (2, 7)] {
            let work = even(1);
            let recorder = Recorder::new(&work);
            renderer
                .render(&recorder, &mut Image::new(width, height).expect("an image"))
                .expect("drawn");
            let record = recorder.finish();
            assert_eq!(record.threads(), 3);
            assert!(record.times_computed(width, height).iter().all(|times| *times == 3));
        }
    }

    /// Catches the sum of the threads' times, and the time of the last.
    #[test]
    fn the_time_of_a_rendering_is_the_mean_of_its_threads() {
        assert_eq!(mean_ns(&[3, 9, 6].map(Duration::from_nanos)), 6);
    }

    /// Catches a warm-up counted as a round, and times of other numbers of threads.
    #[test]
    fn the_latest_renderings_are_those_of_the_rounds() {
        let independent = Independent::default();
        assert_eq!(independent.slowdown(2, &[4]), None);
        let logs = [(2, vec![900, 10, 12, 14]), (3, vec![900, 70])];
        independent.shared.lock().expect("nobody panicked").thread_ns.extend(logs);
        let median =
            |threads, alone: &[u64]| independent.slowdown(threads, alone).map(|found| found.median);
        assert_eq!(median(2, &[10, 8, 10]), Some(1.4));
        assert_eq!(median(3, &[10]), Some(7.0));
        assert_eq!(median(4, &[10]), None);
    }
}
