//! Renders for real and takes the time.

use crate::attempt::attempt;
use crate::compare::{Entry, Executor, Rays, Rendering, Sample};
use crate::poison;
use crate::recorder::{Cost, Tally};
use crate::usage::Usage;
use rayweave_contract::{Image, ImageError, Plan, Rect, Work};
use std::num::NonZeroU32;
use std::time::{Duration, Instant};

/// The executor of real renderings of one work. Only [`Renderer::render`] is in the render time.
///
/// [`Renderer::render`]: rayweave_contract::Renderer::render
pub struct Stopwatch<'a> {
    work: &'a dyn Work,
    tile: NonZeroU32,
    /// One for all renderings: none of them pays for touching fresh memory.
    image: Image,
    begin: Instant,
    /// The primary rays of a tile.
    rays: Option<&'a Cost<'a>>,
}

impl<'a> Stopwatch<'a> {
    /// Will render `work` into a picture of `width` x `height` pixels by tiles of `tile` pixels a
    /// side.
    ///
    /// # Errors
    ///
    /// There is no such picture.
    pub fn new(
        work: &'a dyn Work,
        width: u32,
        height: u32,
        tile: NonZeroU32,
    ) -> Result<Self, ImageError> {
        Ok(Self {
            work,
            tile,
            image: Image::new(width, height)?,
            begin: Instant::now(),
            rays: None,
        })
    }

    /// Counts the primary rays of the warm-up, by those of each tile that a strategy cuts; the
    /// timed renderings stay as they are. Of the whole picture as one tile `rays` tells how many
    /// are needed. Nothing is counted if it does not know of one of these.
    #[must_use]
    pub fn counting(self, rays: &'a Cost<'a>) -> Self {
        Self { rays: Some(rays), ..self }
    }

    /// The latest picture.
    #[must_use]
    pub fn into_picture(self) -> Image {
        self.image
    }

    fn render_work(&mut self, work: &dyn Work, entry: &Entry<'_>) -> Result<Rendering, String> {
        let plan = Plan { threads: entry.threads, tile: self.tile };
        let begin = Instant::now();
        let mut renderer = attempt(|| entry.strategy.prepare(plan))?;
        let prepare_ns = nanoseconds(begin.elapsed());

        poison::fill(&mut self.image);
        let begin = Instant::now();
        let result = attempt(|| renderer.render(work, &mut self.image));
        let render_ns = nanoseconds(begin.elapsed());
        result?;
        let sample = Sample { prepare_ns, render_ns, ..Sample::default() };
        Ok(Rendering { sample, digest: self.image.digest(), first_digest: None })
    }

    /// Prepares `entry` and renders twice with it: once to find out what a single picture takes,
    /// once as it is when everything is warm. A fresh process has to call it, once, or the first is
    /// no [one shot](Sample::one_shot_ns).
    ///
    /// # Errors
    ///
    /// What the strategy says of its failure.
    pub fn one_shot_and_again(&mut self, entry: &Entry<'_>) -> Result<Rendering, String> {
        let plan = Plan { threads: entry.threads, tile: self.tile };
        poison::fill(&mut self.image);
        let begin = Instant::now();
        let mut renderer = attempt(|| entry.strategy.prepare(plan))?;
        let prepare_ns = nanoseconds(begin.elapsed());
        attempt(|| renderer.render(self.work, &mut self.image))?;
        let one_shot_ns = Some(nanoseconds(begin.elapsed()));
        let first_digest = Some(self.image.digest());

        poison::fill(&mut self.image);
        let before = Usage::of_this_process();
        let begin = Instant::now();
        let result = attempt(|| renderer.render(self.work, &mut self.image));
        let render_ns = nanoseconds(begin.elapsed());
        let after = Usage::of_this_process();
        result?;
        let cpu_ns = after.zip(before).map(|(after, before)| nanoseconds(after.since(before).cpu));
        let sample = Sample { prepare_ns, render_ns, one_shot_ns, cpu_ns };
        Ok(Rendering { sample, digest: self.image.digest(), first_digest })
    }
}

impl Executor for Stopwatch<'_> {
    fn render(&mut self, entry: &Entry<'_>) -> Result<Rendering, String> {
        self.render_work(self.work, entry)
    }

    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<(Rendering, Option<Rays>), String> {
        let Some(rays) = self.rays else { return Ok((self.render(entry)?, None)) };
        let tally = Tally::new(self.work, rays);
        let rendering = self.render_work(&tally, entry)?;
        let needed =
            rays(Rect { x: 0, y: 0, width: self.image.width(), height: self.image.height() });
        let counted = tally.finish().zip(needed);
        let rays = counted
            .map(|(primary, needed)| Rays { primary, redundant: primary.saturating_sub(needed) });
        Ok((rendering, rays))
    }

    fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }
}

/// A `u64` of nanoseconds lasts for 584 years.
pub(crate) fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_contract::{
        Granularity, Output, Policy, Renderer, Rgb, Scheduling, Strategy, StrategyError, Threads,
        Tile,
    };
    use std::num::NonZeroUsize;
    use std::sync::atomic::{AtomicUsize, Ordering};

    const GREY: Rgb = [0.5; 3];

    struct Grey;

    impl Work for Grey {
        fn render(&self, tile: &mut Tile<'_>) {
            tile.rows().for_each(|(_, row)| row.fill(GREY));
        }
    }

    /// Renders at first, then no more, and at last not even prepares.
    #[derive(Default)]
    struct Tires {
        prepared: AtomicUsize,
    }

    struct Renders(bool);

    impl Strategy for Tires {
        fn name(&self) -> &'static str {
            "tires"
        }

        fn summary(&self) -> &'static str {
            "works once"
        }

        fn threads(&self) -> Threads {
            Threads::None
        }

        fn policy(&self) -> Policy {
            Policy {
                granularity: Granularity::Tile,
                scheduling: Scheduling::Dynamic { chunk: 1 },
                output: Output::InPlace,
            }
        }

        fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
            let source = std::io::Error::other("tired");
            match self.prepared.fetch_add(1, Ordering::Relaxed) {
                earlier @ 0..2 => Ok(Box::new(Renders(earlier == 0))),
                _ => Err(StrategyError::Spawn {
                    strategy: "tires",
                    threads: plan.threads.get(),
                    source,
                }),
            }
        }
    }

    impl Renderer for Renders {
        fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
            image
                .tiles(NonZeroU32::MIN)
                .iter_mut()
                .filter(|_| self.0)
                .for_each(|tile| work.render(tile));
            Ok(())
        }
    }

    /// Renders by tiles of 2 pixels a side, whatever the plan says.
    struct ByTwos;

    impl Strategy for ByTwos {
        fn name(&self) -> &'static str {
            "by-twos"
        }

        fn summary(&self) -> &'static str {
            "2 x 2 pixels at a time"
        }

        fn threads(&self) -> Threads {
            Threads::None
        }

        fn policy(&self) -> Policy {
            Policy {
                granularity: Granularity::Tile,
                scheduling: Scheduling::Dynamic { chunk: 1 },
                output: Output::InPlace,
            }
        }

        fn prepare(&self, _: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
            Ok(Box::new(Self))
        }
    }

    impl Renderer for ByTwos {
        fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
            let size = NonZeroU32::new(2).expect("not 0");
            image.tiles(size).iter_mut().for_each(|tile| work.render(tile));
            Ok(())
        }
    }

    /// Catches a count by the plan's tiles instead of those that were cut, one in the timed
    /// renderings, and a need other than the whole picture's.
    #[test]
    fn the_warm_up_counts_the_tiles_that_were_cut() {
        let asked = AtomicUsize::new(0);
        let rays = |rect: Rect| {
            asked.fetch_add(1, Ordering::Relaxed);
            Some(u64::from((rect.width + 1) * (rect.height + 1)))
        };
        let plan = NonZeroU32::new(100).expect("not 0");
        let entry = Entry { strategy: &ByTwos, threads: NonZeroUsize::MIN };
        let mut stopwatch = Stopwatch::new(&Grey, 5, 4, plan).expect("a picture").counting(&rays);
        // Four tiles of 2 x 2 and two of 1 x 2; the whole picture is 5 x 4.
        let (primary, needed) = (4 * 9 + 2 * 6, 6 * 5);
        let (rendering, counted) = stopwatch.warm_up(&entry).expect("rendered");
        assert_eq!(counted, Some(Rays { primary, redundant: primary - needed }));
        let before = asked.load(Ordering::Relaxed);
        assert_eq!(stopwatch.render(&entry).map(|again| again.digest), Ok(rendering.digest));
        assert_eq!(asked.load(Ordering::Relaxed), before, "counted in a timed rendering");

        let mut stopwatch = Stopwatch::new(&Grey, 5, 4, plan).expect("a picture");
        assert_eq!(stopwatch.warm_up(&entry).map(|(_, counted)| counted), Ok(None));
    }

    /// Catches a first picture that passes for the second, and spans that are taken at the wrong
    /// places.
    #[test]
    fn a_one_shot_is_prepared_and_rendered_and_then_rendered_again() {
        let entry = Entry { strategy: &ByTwos, threads: NonZeroUsize::MIN };
        let mut stopwatch = Stopwatch::new(&Grey, 3, 2, NonZeroU32::MIN).expect("a picture");
        let Rendering { sample, digest, first_digest } =
            stopwatch.one_shot_and_again(&entry).expect("rendered");
        assert_eq!(first_digest, Some(digest));
        assert!(sample.one_shot_ns.expect("a first one") > sample.prepare_ns);
        assert_eq!(sample.cpu_ns.is_some(), cfg!(unix));

        let tires = Tires::default();
        let entry = Entry { strategy: &tires, threads: NonZeroUsize::MIN };
        let Rendering { digest, first_digest, .. } =
            stopwatch.one_shot_and_again(&entry).expect("rendered");
        assert_eq!((first_digest, tires.prepared.load(Ordering::Relaxed)), (Some(digest), 1));
        let Rendering { digest: again, first_digest, .. } =
            stopwatch.one_shot_and_again(&entry).expect("nothing");
        assert!(again != digest && first_digest == Some(again), "an earlier picture");
    }

    #[test]
    fn an_earlier_picture_does_not_pass_for_a_later_one() {
        let mut stopwatch = Stopwatch::new(&Grey, 3, 2, NonZeroU32::MIN).expect("a picture");
        let entry = Entry { strategy: &Tires::default(), threads: NonZeroUsize::MIN };
        let right = Image::filled(3, 2, GREY).expect("a picture").digest();
        assert_eq!(stopwatch.render(&entry).map(|rendering| rendering.digest), Ok(right));
        assert_ne!(stopwatch.render(&entry).map(|rendering| rendering.digest), Ok(right));
        let error = stopwatch.render(&entry).expect_err("tired");
        assert!(error.starts_with("tires: cannot start 1 threads: tired"), "{error}");
    }
}
