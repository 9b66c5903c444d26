//! What each piece of a picture costs, computed alone on one thread.

use crate::statistics::{lower_quartile, median};
use rayweave_core::image::ImageError;
use rayweave_core::strategy::Piece;
use rayweave_core::{Image, Tile, Work};
use std::num::NonZeroU32;
use std::time::{Duration, Instant};

/// Pixels that share a reading of the clock, which takes as long as a cheap pixel.
const RUN: usize = 16;

/// Passes over each kind of piece; beyond the least number of them only as long as there is time.
const PASSES: std::ops::RangeInclusive<usize> = 3..=9;

const BUDGET: Duration = Duration::from_secs(6);

/// Nanoseconds of every piece, by the kind of piece, in the order of their numbers; of kinds not asked for none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PieceCosts {
    pixels: Vec<f64>,
    rows: Vec<f64>,
    tiles: Vec<f64>,
    /// The whole picture at once.
    whole: f64,
}

impl PieceCosts {
    /// Measures `kinds` of pieces of `work`, taking turns.
    ///
    /// # Errors
    ///
    /// There is no picture of `width` x `height` pixels.
    pub fn measure(
        work: &dyn Work,
        (width, height): (u32, u32),
        tile: NonZeroU32,
        kinds: &[Piece],
        mut progress: impl FnMut(f64),
    ) -> Result<Self, ImageError> {
        let mut image = Image::new(width, height)?;
        let begin = Instant::now();
        let mut passes: Vec<Self> = Vec::new();
        while passes.len() < *PASSES.start() || (passes.len() < *PASSES.end() && begin.elapsed() < BUDGET) {
            progress((passes.len() as f64 / *PASSES.start() as f64).min(1.0));
            passes.push(Self::pass(work, &mut image, tile, kinds));
        }
        Ok(Self {
            pixels: typical(&passes, |pass| &pass.pixels),
            rows: typical(&passes, |pass| &pass.rows),
            tiles: typical(&passes, |pass| &pass.tiles),
            whole: median(&passes.iter().map(|pass| pass.whole).collect::<Vec<_>>()).unwrap_or(0.0),
        })
    }

    fn pass(work: &dyn Work, image: &mut Image, tile: NonZeroU32, kinds: &[Piece]) -> Self {
        let mut costs = Self::default();
        let width = image.width() as usize;
        if kinds.contains(&Piece::Pixel) {
            for (run, colors) in image.pixels_mut().chunks_mut(RUN).enumerate() {
                let length = colors.len();
                let time = time(|| {
                    for (index, color) in (run * RUN..).zip(colors) {
                        work.render(&mut Tile::pixel((index % width) as u32, (index / width) as u32, color));
                    }
                });
                costs.pixels.resize(costs.pixels.len() + length, time / length as f64);
            }
        }
        if kinds.contains(&Piece::Row) || kinds.contains(&Piece::Band) {
            let rows = (0..).zip(image.pixels_mut().chunks_mut(width));
            costs.rows = rows.map(|(y, row)| time(|| work.render(&mut Tile::row(0, y, row)))).collect();
        }
        if kinds.contains(&Piece::Tile) {
            costs.tiles = image.tiles(tile).iter_mut().map(|tile| time(|| work.render(tile))).collect();
        }
        if kinds.contains(&Piece::Band) {
            // Tiles larger than the picture: one.
            costs.whole =
                image.tiles(NonZeroU32::MAX).iter_mut().map(|tile| time(|| work.render(tile))).sum();
        }
        costs
    }

    /// What each piece costs where `threads` threads compute, in nanoseconds.
    ///
    /// A band's cost is put together: as its rows at once are cheaper than one by one, each row costs a share of
    /// itself, and the band's first row the rest too; the share is the one that is right for the whole picture.
    #[must_use]
    pub fn of(&self, piece: Piece, threads: usize) -> Vec<f64> {
        match piece {
            Piece::Pixel => self.pixels.clone(),
            Piece::Row => self.rows.clone(),
            Piece::Tile => self.tiles.clone(),
            Piece::Band => {
                let first = self.rows.first().copied().unwrap_or(0.0);
                let others = self.rows.iter().sum::<f64>() - first;
                let share = if others > 0.0 { ((self.whole - first) / others).clamp(0.0, 1.0) } else { 1.0 };
                let begin = |thread: usize| self.rows.len() * thread / threads;
                (0..threads)
                    .map(|thread| match &self.rows[begin(thread)..begin(thread + 1)] {
                        [] => 0.0,
                        [first, others @ ..] => first + share * others.iter().sum::<f64>(),
                    })
                    .collect()
            }
        }
    }
}

/// Nanoseconds of `action`.
fn time(action: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    action();
    begin.elapsed().as_nanos() as f64
}

/// Of each piece the lower quartile, all scaled to the median of what a pass takes. Among themselves pieces are as
/// they are undisturbed; but a short one finds a moment without disturbance sooner than a long one, and would seem
/// cheaper beside other kinds than it is.
fn typical(passes: &[PieceCosts], of: fn(&PieceCosts) -> &Vec<f64>) -> Vec<f64> {
    let pieces = passes.first().map_or(0, |pass| of(pass).len());
    let quartile =
        |piece: usize| lower_quartile(&passes.iter().map(|pass| of(pass)[piece]).collect::<Vec<_>>());
    let quartiles: Vec<f64> = (0..pieces).filter_map(quartile).collect();
    let totals: Vec<f64> = passes.iter().map(|pass| of(pass).iter().sum()).collect();
    let total: f64 = quartiles.iter().sum();
    let factor = median(&totals).filter(|_| total > 0.0).map_or(1.0, |median| median / total);
    quartiles.into_iter().map(|cost| cost * factor).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::even;

    /// Catches kinds that are cut wrongly: 7 x 5 pixels in tiles of 4 are 2 x 2 tiles.
    #[test]
    fn a_cost_for_each_piece_of_the_kinds_asked_for() {
        let tile = NonZeroU32::new(4).expect("not 0");
        let costs = |kinds: &[Piece]| {
            let costs = PieceCosts::measure(&even(50), (7, 5), tile, kinds, |_| ()).expect("a picture");
            [Piece::Pixel, Piece::Row, Piece::Tile].map(|piece| costs.of(piece, 1).len())
        };
        assert_eq!(costs(&[Piece::Pixel, Piece::Row, Piece::Tile]), [35, 5, 4]);
        assert_eq!(costs(&[Piece::Band]), [0, 5, 0]);
        assert_eq!(costs(&[Piece::Tile]), [0, 0, 4]);
    }

    /// Rows of 10 each alone, but 28 for all four together: what follows a row costs 6.
    #[test]
    fn bands_are_cheaper_than_their_rows() {
        let costs = PieceCosts { rows: vec![10.0; 4], whole: 28.0, ..PieceCosts::default() };
        assert_eq!(costs.of(Piece::Band, 1), [28.0]);
        assert_eq!(costs.of(Piece::Band, 2), [16.0, 16.0]);
        assert_eq!(costs.of(Piece::Band, 3), [10.0, 10.0, 16.0]);
        // More threads than rows: some have nothing.
        assert_eq!(costs.of(Piece::Band, 6), [0.0, 10.0, 10.0, 0.0, 10.0, 10.0]);
        let slower = PieceCosts { whole: 99.0, ..costs };
        assert_eq!(slower.of(Piece::Band, 1), [40.0], "no row is dearer in company");
    }

    /// The least are 3 and 4 and make 7, where a pass takes 14 in the median.
    #[test]
    fn pieces_are_told_apart_undisturbed_and_take_what_a_pass_takes() {
        let pass = |rows: [f64; 2]| PieceCosts { rows: rows.to_vec(), ..PieceCosts::default() };
        let passes = [pass([3.0, 11.0]), pass([5.0, 4.0]), pass([9.0, 6.0])];
        assert_eq!(typical(&passes, |pass| &pass.rows), [6.0, 8.0]);
        assert!(typical(&passes, |pass| &pass.tiles).is_empty());
        assert_eq!(typical(&[pass([0.0, 0.0])], |pass| &pass.rows), [0.0, 0.0]);
    }
}
