//! Synthetic work with a chosen cost for each pixel. It has no scene and shares no memory.

use rayweave_contract::{Rgb, Tile, Work};

/// A busy loop at each pixel `(x, y)` of as many steps as the function returns. A pixel's colour
/// follows from its place and its steps alone, so that an image can be verified.
#[derive(Clone, Copy, Debug)]
pub struct Synthetic<Steps>(pub Steps);

/// Returns a work of `steps` steps at every pixel.
#[must_use]
pub fn even(steps: u32) -> Synthetic<impl Fn(u32, u32) -> u32 + Sync> {
    Synthetic(move |_, _| steps)
}

impl<Steps: Fn(u32, u32) -> u32 + Sync> Work for Synthetic<Steps> {
    fn render(&self, tile: &mut Tile<'_>) {
        let left = tile.rect().x;
        for (y, row) in tile.rows() {
            for (x, pixel) in (left..).zip(row) {
                *pixel = color(x, y, (self.0)(x, y));
            }
        }
    }
}

fn color(x: u32, y: u32, steps: u32) -> Rgb {
    let begin = (u64::from(x) << 32 | u64::from(y)) ^ 0x9e37_79b9_7f4a_7c15;
    let state = (0..steps).fold(begin, |state, _| step(state));
    // 21 bits a channel, which an `f32` holds exactly.
    [0, 21, 42].map(|shift| (state >> shift & 0x1f_ffff) as f32 / 0x20_0000 as f32)
}

/// Returns the next state. Each step depends on the one before, and compilers cannot shorten it.
/// Source: Marsaglia, "Xorshift RNGs", 2003.
fn step(mut state: u64) -> u64 {
    state ^= state << 13;
    state ^= state >> 7;
    state ^ state << 17
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_contract::Image;
    use std::num::NonZeroU32;

    /// Catches colours that depend on the tile, or do not depend on the steps or the place.
    #[test]
    fn a_color_follows_from_place_and_steps() {
        let draw = |work: &dyn Work, tile| {
            let mut image = Image::new(5, 3).expect("an image");
            image
                .tiles(NonZeroU32::new(tile).expect("not 0"))
                .iter_mut()
                .for_each(|tile| work.render(tile));
            image
        };
        let image = draw(&even(3), 2);
        assert_eq!(image, draw(&even(3), 5));
        assert_ne!(image, draw(&even(4), 5));
        let mut colors = image.pixels().to_vec();
        colors.dedup();
        assert_eq!(colors.len(), 15);
        let half = draw(&Synthetic(|_, y| 3 * (y / 2)), 1);
        assert_eq!(half.pixels()[10..], image.pixels()[10..]);
        assert_eq!(half.pixels()[..10], draw(&even(0), 1).pixels()[..10]);
    }
}
