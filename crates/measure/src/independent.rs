//! The ceiling: threads that share nothing, each of which draws the whole picture.

use rayweave_core::strategy::{Dealing, Delivery, Piece, Rule, panic_message, render_tile};
use rayweave_core::{Image, Plan, Renderer, Strategy, StrategyError, ThreadsStart, Work};
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

const NAME: &str = "independent";

/// No way to share work: with N threads the picture is drawn N times. How much longer that takes than once is what the
/// machine's cores cost each other; by sharing nobody does better.
#[derive(Debug, Default)]
pub struct Independent {
    /// Of each thread but the first, kept so that no rendering but the first pays for fresh memory.
    copies: Arc<Mutex<Vec<Image>>>,
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
        Ok(Box::new(Copying { plan, copies: Arc::clone(&self.copies) }))
    }
}

struct Copying {
    plan: Plan,
    copies: Arc<Mutex<Vec<Image>>>,
}

impl Renderer for Copying {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let threads = self.plan.threads.get();
        let cannot_start = |source| StrategyError::Spawn { strategy: NAME, threads, source };
        let mut copies = self.copies.lock().unwrap_or_else(PoisonError::into_inner);
        copies.retain(|copy| (copy.width(), copy.height()) == (image.width(), image.height()));
        while copies.len() < threads - 1 {
            let copy = Image::new(image.width(), image.height());
            copies.push(copy.map_err(|e| cannot_start(io::Error::other(e)))?);
        }
        let draw = |image: &mut Image| {
            image.tiles(self.plan.tile).iter_mut().try_for_each(|tile| render_tile(NAME, work, tile))
        };
        thread::scope(|scope| {
            let others = copies[..threads - 1].iter_mut().map(|copy| {
                let thread = thread::Builder::new().name(NAME.to_owned());
                thread.spawn_scoped(scope, || draw(copy)).map_err(cannot_start)
            });
            let others = others.collect::<Result<Vec<_>, _>>()?;
            let own = draw(image);
            for other in others {
                other
                    .join()
                    .map_err(|payload| cannot_start(io::Error::other(panic_message(&*payload))))??;
            }
            own
        })
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
}
