//! Images of synthetic work to time renderers with. Every image is verified, outside of the timed
//! span.
//!
//! The cost of dispatch is measured on columns of pixels with tiles of one pixel. In a column a
//! pixel, a row and a tile are the same, and a piece can have next to no work.

use crate::catch_panic::catch_panic;
use crate::sentinel;
use crate::synthetic::even;
use rayweave_contract::{Image, Renderer, Tile, Work};
use std::time::Instant;

/// The lengths in pixels of the two columns of a [`DispatchProbe`].
const SHORT: u32 = 1 << 8;
const LONG: u32 = 1 << 14;

/// A work, the image that it gives, and an image to render into.
pub(crate) struct TimedImage {
    work: Box<dyn Work>,
    expected: Image,
    image: Image,
}

impl TimedImage {
    /// Returns an image of `width` x `height` pixels of `work`.
    ///
    /// # Errors
    ///
    /// There is no image of this size.
    pub(crate) fn new(work: impl Work + 'static, width: u32, height: u32) -> Result<Self, String> {
        let image = Image::new(width, height).map_err(|e| e.to_string())?;
        let mut expected = image.clone();
        for (y, row) in (0..).zip(expected.pixels_mut().chunks_mut(width as usize)) {
            work.render(&mut Tile::row(0, y, row));
        }
        Ok(Self { work: Box::new(work), expected, image })
    }

    /// Returns a column of `pixels` pixels, each with `steps` steps of synthetic work.
    pub(crate) fn column(pixels: u32, steps: u32) -> Result<Self, String> {
        Self::new(even(steps), 1, pixels)
    }

    /// Returns the nanoseconds that `renderer` takes.
    ///
    /// # Errors
    ///
    /// The renderer fails, or gives another image.
    pub(crate) fn time(&mut self, renderer: &mut Renderer) -> Result<f64, String> {
        sentinel::fill(&mut self.image);
        let begin = Instant::now();
        let result = catch_panic(|| renderer.render(&*self.work, &mut self.image));
        let time = begin.elapsed().as_nanos() as f64;
        result?;
        if self.image == self.expected {
            Ok(time)
        } else {
            Err("a wrong image of synthetic work".to_owned())
        }
    }
}

/// A probe for the cost of dispatch: two columns without work, one short and one long.
pub(crate) struct DispatchProbe {
    short: TimedImage,
    long: TimedImage,
}

impl DispatchProbe {
    pub(crate) fn new() -> Result<Self, String> {
        Ok(Self { short: TimedImage::column(SHORT, 0)?, long: TimedImage::column(LONG, 0)? })
    }

    /// Returns the nanoseconds that `renderer` takes for the short column and for the long one.
    pub(crate) fn time(&mut self, renderer: &mut Renderer) -> Result<[f64; 2], String> {
        // Not counted: the first list of so many tiles pays for fresh memory.
        self.long.time(renderer)?;
        Ok([self.short.time(renderer)?, self.long.time(renderer)?])
    }

    /// Returns the nanoseconds of dispatch for each piece, from the times of both columns. The
    /// cost that a rendering has once cancels.
    pub(crate) fn slope([short, long]: [f64; 2]) -> f64 {
        (long - short) / f64::from(LONG - SHORT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fakes::{complete, skip};
    use rayweave_contract::{Plan, Strategy, Threads};
    use std::num::{NonZeroU32, NonZeroUsize};

    /// Catches a time of a wrong image, and one that is right only by the rendering before.
    #[test]
    fn a_wrong_image_has_no_time() {
        let renderer = |left_out| {
            let strategy =
                Strategy { prepare: &|_| skip(left_out), ..complete("fake", Threads::None) };
            let plan = Plan { threads: NonZeroUsize::MIN, tile: NonZeroU32::MIN };
            strategy.prepare(plan).expect("a renderer")
        };
        let mut column = TimedImage::column(9, 2).expect("an image");
        assert!(column.time(&mut renderer(0)).is_ok());
        assert_eq!(
            column.time(&mut renderer(1)),
            Err("a wrong image of synthetic work".to_owned())
        );
        assert!(column.time(&mut renderer(0)).is_ok());
    }
}
