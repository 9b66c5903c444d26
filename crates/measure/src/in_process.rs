//! An executor that renders in this process and takes the times.

use crate::catch_panic::catch_panic;
use crate::compare::{Entry, Executor};
use crate::measurement::Sample;
use crate::recorder::{RayCost, RayCounter};
use crate::sentinel;
use crate::usage::Usage;
use rayweave_contract::{Image, ImageError, Plan, Rect, Work};
use std::num::NonZeroU32;
use std::time::{Duration, Instant};

/// The executor that renders one work in this process. Only [`Renderer::render`] is in the time to
/// render.
///
/// [`Renderer::render`]: rayweave_contract::Renderer::render
pub struct InProcessExecutor<'a> {
    work: &'a dyn Work,
    tile: NonZeroU32,
    /// The image of all renderings, so that only the first pays for fresh memory.
    image: Image,
    begin: Instant,
    /// The numbers of primary rays and of their packets of a tile.
    counts: Option<[&'a RayCost<'a>; 2]>,
}

impl<'a> InProcessExecutor<'a> {
    /// Returns an executor that renders `work` into an image of `width` x `height` pixels by tiles
    /// of `tile` pixels a side.
    ///
    /// # Errors
    ///
    /// There is no image of this size.
    pub fn new(
        work: &'a dyn Work,
        width: u32,
        height: u32,
        tile: NonZeroU32,
    ) -> Result<Self, ImageError> {
        let image = Image::new(width, height)?;
        Ok(Self { work, tile, image, begin: Instant::now(), counts: None })
    }

    /// Lets the warm-up count primary rays and their packets: `rays` and `packets` return those of
    /// a tile, or of the whole image as one tile. Nothing is counted if `None` is returned for one
    /// of them. Timed renderings do not count.
    #[must_use]
    pub fn counting(self, rays: &'a RayCost<'a>, packets: &'a RayCost<'a>) -> Self {
        Self { counts: Some([rays, packets]), ..self }
    }

    /// Returns the latest image.
    #[must_use]
    pub fn into_image(self) -> Image {
        self.image
    }

    fn render_work(&mut self, work: &dyn Work, entry: &Entry<'_>) -> Result<Sample, String> {
        let plan = Plan { threads: entry.threads, tile: self.tile };
        let begin = Instant::now();
        let mut renderer = catch_panic(|| entry.strategy.prepare(plan))?;
        let prepare_ns = nanoseconds(begin.elapsed());

        sentinel::fill(&mut self.image);
        let begin = Instant::now();
        let result = catch_panic(|| renderer.render(work, &mut self.image));
        let render_ns = nanoseconds(begin.elapsed());
        result?;
        Ok(Sample::new(prepare_ns, render_ns, self.image.digest()))
    }

    /// Prepares `entry` and renders twice with it: cold, as a program that draws a single image
    /// would, and warm. Call it once in a fresh process; otherwise the first rendering is not
    /// [cold](Sample::cold_ns).
    ///
    /// # Errors
    ///
    /// The strategy's own message.
    pub fn cold_and_warm(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        let plan = Plan { threads: entry.threads, tile: self.tile };
        sentinel::fill(&mut self.image);
        let begin = Instant::now();
        let mut renderer = catch_panic(|| entry.strategy.prepare(plan))?;
        let prepare_ns = nanoseconds(begin.elapsed());
        catch_panic(|| renderer.render(self.work, &mut self.image))?;
        let cold_ns = Some(nanoseconds(begin.elapsed()));
        let cold_digest = Some(self.image.digest());

        sentinel::fill(&mut self.image);
        let before = Usage::of_this_process();
        let begin = Instant::now();
        let result = catch_panic(|| renderer.render(self.work, &mut self.image));
        let render_ns = nanoseconds(begin.elapsed());
        let after = Usage::of_this_process();
        result?;
        let cpu_ns = after.zip(before).map(|(after, before)| nanoseconds(after.since(before).cpu));
        let sample = Sample::new(prepare_ns, render_ns, self.image.digest());
        Ok(Sample { cold_ns, cpu_ns, cold_digest, ..sample })
    }
}

impl Executor for InProcessExecutor<'_> {
    fn render(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        self.render_work(self.work, entry)
    }

    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<Sample, String> {
        let Some([rays, packets]) = self.counts else { return self.render(entry) };
        let counter = RayCounter::new(self.work, rays);
        let packet_counter = RayCounter::new(&counter, packets);
        let sample = self.render_work(&packet_counter, entry)?;
        let primary_packets = packet_counter.finish();
        let whole = Rect { x: 0, y: 0, width: self.image.width(), height: self.image.height() };
        let Some((primary, needed)) = counter.finish().zip(rays(whole)) else { return Ok(sample) };
        let redundant_rays = Some(primary.saturating_sub(needed));
        Ok(Sample { primary_rays: Some(primary), redundant_rays, primary_packets, ..sample })
    }

    fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }
}

/// Returns the nanoseconds of `duration`; a `u64` of them lasts for 584 years.
pub(crate) fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fakes::{GREY, Grey, complete, skip};
    use rayweave_contract::{RenderError, RenderFn, Strategy, Threads};
    use std::num::NonZeroUsize;
    use std::sync::atomic::{AtomicUsize, Ordering};

    static COMPLETE: Strategy = complete("complete", Threads::None);

    /// Prepares a strategy that renders at first, then nothing, and at last cannot be prepared.
    fn tire(prepared: &AtomicUsize) -> Result<RenderFn, RenderError> {
        match prepared.fetch_add(1, Ordering::Relaxed) {
            0 => skip(0),
            1 => skip(usize::MAX),
            _ => Err(RenderError::Spawn { threads: 1, source: std::io::Error::other("tired") }),
        }
    }

    /// Catches a count by the plan's tiles instead of the rendered ones, a count in timed
    /// renderings, and a need other than the whole image's.
    #[test]
    fn the_warm_up_counts_the_rendered_tiles() {
        let asked = AtomicUsize::new(0);
        let rays = |rect: Rect| {
            asked.fetch_add(1, Ordering::Relaxed);
            Some(u64::from((rect.width + 1) * (rect.height + 1)))
        };
        let packets = |rect: Rect| Some(u64::from(rect.width));
        let plan = NonZeroU32::new(100).expect("not 0");
        let entry = Entry { strategy: COMPLETE, threads: NonZeroUsize::MIN };
        let mut executor =
            InProcessExecutor::new(&Grey, 5, 4, plan).expect("an image").counting(&rays, &packets);
        // Four tiles of 2 x 2 and two of 1 x 2; the whole image is 5 x 4.
        let (primary, needed) = (4 * 9 + 2 * 6, 6 * 5);
        let counted = executor.warm_up(&entry).expect("rendered");
        assert_eq!(
            (counted.primary_rays, counted.redundant_rays),
            (Some(primary), Some(primary - needed))
        );
        assert_eq!(counted.primary_packets, Some(4 * 2 + 2));
        let before = asked.load(Ordering::Relaxed);
        assert_eq!(executor.render(&entry).map(|again| again.digest), Ok(counted.digest));
        assert_eq!(asked.load(Ordering::Relaxed), before, "counted in a timed rendering");

        let mut executor = InProcessExecutor::new(&Grey, 5, 4, plan).expect("an image");
        assert_eq!(executor.warm_up(&entry).map(|sample| sample.primary_rays), Ok(None));
    }

    /// Catches a first image that passes for the second, and times of the wrong spans.
    #[test]
    fn a_cold_rendering_is_prepared_and_rendered_and_then_rendered_again() {
        let entry = Entry { strategy: COMPLETE, threads: NonZeroUsize::MIN };
        let mut executor = InProcessExecutor::new(&Grey, 3, 2, NonZeroU32::MIN).expect("an image");
        let sample = executor.cold_and_warm(&entry).expect("rendered");
        assert_eq!(sample.cold_digest, Some(sample.digest));
        assert!(sample.cold_ns.expect("a first one") > sample.prepare_ns);
        assert_eq!(sample.cpu_ns.is_some(), cfg!(unix));

        let prepared = AtomicUsize::new(0);
        let tires = |_| tire(&prepared);
        let strategy = Strategy { prepare: &tires, ..COMPLETE };
        let entry = Entry { strategy, threads: NonZeroUsize::MIN };
        let Sample { digest, cold_digest, .. } = executor.cold_and_warm(&entry).expect("rendered");
        assert_eq!((cold_digest, prepared.load(Ordering::Relaxed)), (Some(digest), 1));
        let Sample { digest: again, cold_digest, .. } =
            executor.cold_and_warm(&entry).expect("nothing");
        assert!(again != digest && cold_digest == Some(again), "an earlier image");
    }

    #[test]
    fn an_earlier_image_does_not_pass_for_a_later_one() {
        let mut executor = InProcessExecutor::new(&Grey, 3, 2, NonZeroU32::MIN).expect("an image");
        let prepared = AtomicUsize::new(0);
        let tires = |_| tire(&prepared);
        let strategy = Strategy { name: "tires", prepare: &tires, ..COMPLETE };
        let entry = Entry { strategy, threads: NonZeroUsize::MIN };
        let right = Image::filled(3, 2, GREY).expect("an image").digest();
        assert_eq!(executor.render(&entry).map(|rendering| rendering.digest), Ok(right));
        assert_ne!(executor.render(&entry).map(|rendering| rendering.digest), Ok(right));
        let error = executor.render(&entry).expect_err("tired");
        assert!(error.starts_with("tires: cannot start 1 threads: tired"), "{error}");
    }
}
