//! Pictures of synthetic work to time renderers with. Every picture is verified, outside of the
//! time.
//!
//! The cost of dispatch is measured on columns of pixels, with tiles of one pixel: there a pixel, a
//! row and a tile are the same, and the work of a piece can be next to nothing.

use crate::catch_panic::catch_panic;
use crate::sentinel;
use crate::synthetic::even;
use rayweave_contract::{Image, Renderer, Tile, Work};
use std::time::Instant;

/// Pixels of the two columns whose difference is divided by that of their lengths.
const SHORT: u32 = 1 << 8;
const LONG: u32 = 1 << 14;

/// A work, and its picture.
pub(crate) struct Sheet {
    work: Box<dyn Work>,
    expected: Image,
    image: Image,
}

impl Sheet {
    /// Of `width` x `height` pixels.
    ///
    /// # Errors
    ///
    /// There is no such picture.
    pub(crate) fn new(work: impl Work + 'static, width: u32, height: u32) -> Result<Self, String> {
        let image = Image::new(width, height).map_err(|e| e.to_string())?;
        let mut expected = image.clone();
        for (y, row) in (0..).zip(expected.pixels_mut().chunks_mut(width as usize)) {
            work.render(&mut Tile::row(0, y, row));
        }
        Ok(Self { work: Box::new(work), expected, image })
    }

    /// One below the other, of `steps` steps each.
    pub(crate) fn column(pixels: u32, steps: u32) -> Result<Self, String> {
        Self::new(even(steps), 1, pixels)
    }

    /// Nanoseconds that `renderer` takes.
    ///
    /// # Errors
    ///
    /// The renderer fails, or draws another picture.
    pub(crate) fn time(&mut self, renderer: &mut dyn Renderer) -> Result<f64, String> {
        sentinel::fill(&mut self.image);
        let begin = Instant::now();
        let result = catch_panic(|| renderer.render(&*self.work, &mut self.image));
        let time = begin.elapsed().as_nanos() as f64;
        result?;
        if self.image == self.expected {
            Ok(time)
        } else {
            Err("a wrong picture of synthetic work".to_owned())
        }
    }
}

/// What the cost of dispatch is measured with.
pub(crate) struct Columns {
    short: Sheet,
    long: Sheet,
}

impl Columns {
    pub(crate) fn new() -> Result<Self, String> {
        Ok(Self { short: Sheet::column(SHORT, 0)?, long: Sheet::column(LONG, 0)? })
    }

    /// Nanoseconds that `renderer` takes for the short one and for the long one.
    pub(crate) fn time(&mut self, renderer: &mut dyn Renderer) -> Result<[f64; 2], String> {
        // Not counted: a list of so many tiles takes memory, and the first to have it would pay for
        // it.
        self.long.time(renderer)?;
        Ok([self.short.time(renderer)?, self.long.time(renderer)?])
    }

    /// Nanoseconds a piece of next to no work, of the times of both: what is paid once for a
    /// rendering cancels.
    pub(crate) fn slope([short, long]: [f64; 2]) -> f64 {
        (long - short) / f64::from(LONG - SHORT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_contract::StrategyError;

    /// Draws all but the last so many pixels.
    struct Lazy(usize);

    impl Renderer for Lazy {
        fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
            let drawn = image.pixels().len() - self.0;
            for (y, pixel) in (0..).zip(&mut image.pixels_mut()[..drawn]) {
                work.render(&mut Tile::pixel(0, y, pixel));
            }
            Ok(())
        }
    }

    /// Catches a time that is taken of a wrong picture, or of one that was right the time before.
    #[test]
    fn no_time_without_the_picture() {
        let mut column = Sheet::column(9, 2).expect("a picture");
        assert!(column.time(&mut Lazy(0)).is_ok());
        assert_eq!(column.time(&mut Lazy(1)), Err("a wrong picture of synthetic work".to_owned()));
        assert!(column.time(&mut Lazy(0)).is_ok());
    }
}
