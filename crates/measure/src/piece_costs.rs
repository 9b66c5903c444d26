//! Measures the cost of each piece of an image, on one thread.

use crate::statistics::lower_quartile;
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Prepare, RenderError, Scheduling, Strategy, Threads,
    Tile, Work, render_tile, renderer,
};
use std::num::NonZeroU32;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The number of pixels that are timed together, because a clock reading takes as long as a cheap
/// pixel.
const RUN: usize = 16;

/// The pieces that an image is cut into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// One pixel at a time.
    Pixels,
    /// One row at a time.
    Rows,
    /// Tiles of [`Plan::tile`].
    Tiles,
    /// The whole image at once.
    Whole,
}

impl Cut {
    /// Returns the cuts that are needed for the costs of pieces of these granularities.
    #[must_use]
    pub fn for_pieces(granularities: &[Granularity]) -> Vec<Self> {
        let is_needed = |cut: &Self| {
            granularities.iter().any(|granularity| match granularity {
                Granularity::Pixel => *cut == Self::Pixels,
                Granularity::Row => *cut == Self::Rows,
                Granularity::Tile => *cut == Self::Tiles,
                Granularity::Band => matches!(cut, Self::Rows | Self::Whole),
            })
        };
        [Self::Pixels, Self::Rows, Self::Tiles, Self::Whole].into_iter().filter(is_needed).collect()
    }

    /// Returns the number of pieces that are timed together.
    fn run(self) -> usize {
        if self == Self::Pixels { RUN } else { 1 }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels one by one",
            Self::Rows => "rows one by one",
            Self::Tiles => "tiles one by one",
            Self::Whole => "all at once",
        }
    }
}

/// A strategy that does not share work: the caller's thread renders and times one piece after the
/// other. As an entry of a comparison it is measured in the same rounds as the others.
pub struct OneByOne {
    cut: Cut,
    log: Arc<Mutex<Log>>,
    prepare: Box<Prepare<'static>>,
}

/// The times of all renderings so far.
#[derive(Debug, Default)]
struct Log {
    /// The number of pieces of a rendering.
    pieces: usize,
    /// The nanoseconds of every [run](Cut::run) of pieces, by rendering. The last run may be
    /// shorter.
    passes: Vec<Vec<f64>>,
}

impl OneByOne {
    /// Returns a strategy for this cut, without a measurement yet.
    #[must_use]
    pub fn new(cut: Cut) -> Self {
        let log = Arc::<Mutex<Log>>::default();
        let kept = Arc::clone(&log);
        let prepare = move |plan| {
            let log = Arc::clone(&kept);
            renderer(move |work, image| render(plan, cut, &log, work, image))
        };
        Self { cut, log, prepare: Box::new(prepare) }
    }

    /// Returns the strategy, an entry of a comparison.
    #[must_use]
    pub fn strategy(&self) -> Strategy<'_> {
        let granularity = match self.cut {
            Cut::Pixels => Granularity::Pixel,
            Cut::Rows => Granularity::Row,
            Cut::Tiles => Granularity::Tile,
            Cut::Whole => Granularity::Band,
        };
        Strategy {
            name: self.cut.name(),
            summary: "one thread renders and times each piece",
            threads: Threads::None,
            policy: Policy::new(granularity, Scheduling::Static, Output::InPlace),
            unavailable: None,
            prepare: &*self.prepare,
        }
    }

    /// Returns the nanoseconds of every piece, which sum to `total`. They are in proportion to the
    /// lower quartile of each over all renderings, the warm-up included, because interference only
    /// adds time. The sum is given because long pieces are disturbed more often than short ones.
    #[must_use]
    pub fn costs(&self, total: f64) -> Vec<f64> {
        let log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        spread(&scaled(&log.passes, total), self.cut.run(), log.pieces)
    }
}

fn render(
    plan: Plan,
    cut: Cut,
    log: &Mutex<Log>,
    work: &dyn Work,
    image: &mut Image,
) -> Result<(), RenderError> {
    let width = image.width() as usize;
    let timed = |tile: &mut Tile<'_>| {
        let begin = Instant::now();
        render_tile(work, tile)?;
        Ok(begin.elapsed().as_nanos() as f64)
    };
    let costs: Result<Vec<f64>, RenderError> = match cut {
        Cut::Pixels => pixels(work, image),
        Cut::Rows => (0..)
            .zip(image.pixels_mut().chunks_mut(width))
            .map(|(y, row)| timed(&mut Tile::row(0, y, row)))
            .collect(),
        Cut::Tiles => image.tiles(plan.tile).iter_mut().map(timed).collect(),
        // With tiles larger than the image there is one.
        Cut::Whole => image.tiles(NonZeroU32::MAX).iter_mut().map(timed).collect(),
    };
    let costs = costs?;
    let mut log = log.lock().unwrap_or_else(PoisonError::into_inner);
    log.pieces = if cut == Cut::Pixels { image.pixels().len() } else { costs.len() };
    log.passes.push(costs);
    Ok(())
}

/// Renders the pixels, and times [`RUN`] of them together.
fn pixels(work: &dyn Work, image: &mut Image) -> Result<Vec<f64>, RenderError> {
    let width = image.width() as usize;
    let mut costs = Vec::with_capacity(image.pixels().len().div_ceil(RUN));
    for (run, colors) in image.pixels_mut().chunks_mut(RUN).enumerate() {
        let begin = Instant::now();
        for (index, color) in (run * RUN..).zip(colors) {
            let mut tile = Tile::pixel((index % width) as u32, (index / width) as u32, color);
            render_tile(work, &mut tile)?;
        }
        costs.push(begin.elapsed().as_nanos() as f64);
    }
    Ok(costs)
}

/// Returns the costs of runs as [`OneByOne::costs`] does those of pieces.
fn scaled(passes: &[Vec<f64>], total: f64) -> Vec<f64> {
    let runs = passes.first().map_or(0, Vec::len);
    let quartile =
        |run: usize| lower_quartile(&passes.iter().map(|pass| pass[run]).collect::<Vec<_>>());
    let quartiles: Vec<f64> = (0..runs).filter_map(quartile).collect();
    let sum: f64 = quartiles.iter().sum();
    let factor = if sum > 0.0 { total / sum } else { 1.0 };
    quartiles.into_iter().map(|cost| cost * factor).collect()
}

/// Returns the costs of `pieces` pieces: each has an even share of its run. Runs have `length`
/// pieces; the last has the rest.
fn spread(runs: &[f64], length: usize, pieces: usize) -> Vec<f64> {
    let mut costs = Vec::with_capacity(pieces);
    for run in runs {
        let length = length.min(pieces - costs.len());
        costs.resize(costs.len() + length, run / length as f64);
    }
    costs
}

/// The nanoseconds of every piece, by kind of piece, in the order of their numbers. Kinds that were
/// not measured are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PieceCosts {
    pixels: Vec<f64>,
    rows: Vec<f64>,
    tiles: Vec<f64>,
    /// The cost of the whole image at once.
    whole: f64,
}

impl PieceCosts {
    /// Returns the costs `measured`, each with its speed-up over a reference that takes
    /// `reference_ns`.
    #[must_use]
    pub fn new(measured: &[(&OneByOne, f64)], reference_ns: f64) -> Self {
        let mut costs = Self::default();
        for (one_by_one, speedup) in measured {
            let of_pieces = one_by_one.costs(reference_ns / speedup);
            match one_by_one.cut {
                Cut::Pixels => costs.pixels = of_pieces,
                Cut::Rows => costs.rows = of_pieces,
                Cut::Tiles => costs.tiles = of_pieces,
                Cut::Whole => costs.whole = of_pieces.iter().sum(),
            }
        }
        costs
    }

    /// Returns whether the pieces of this granularity were measured.
    #[must_use]
    pub fn know(&self, granularity: Granularity) -> bool {
        match granularity {
            Granularity::Pixel => !self.pixels.is_empty(),
            Granularity::Row => !self.rows.is_empty(),
            Granularity::Tile => !self.tiles.is_empty(),
            Granularity::Band => !self.rows.is_empty() && self.whole > 0.0,
        }
    }

    /// Returns the cost of each piece for `threads` threads, in nanoseconds.
    ///
    /// A band's cost is composed of its rows' costs. Rows at once are cheaper than one by one, so
    /// the first row of a band counts in full, and each other row by a share. The share is the one
    /// that gives the cost of the whole image.
    #[must_use]
    pub fn of(&self, granularity: Granularity, threads: usize) -> Vec<f64> {
        match granularity {
            Granularity::Pixel => self.pixels.clone(),
            Granularity::Row => self.rows.clone(),
            Granularity::Tile => self.tiles.clone(),
            Granularity::Band => {
                let first = self.rows.first().copied().unwrap_or(0.0);
                let others = self.rows.iter().sum::<f64>() - first;
                let share = if others > 0.0 {
                    ((self.whole - first) / others).clamp(0.0, 1.0)
                } else {
                    1.0
                };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::even;
    use std::num::NonZeroUsize;

    /// Returns the strategy of `cut` after two renderings of an image of 7 x 5 pixels, in tiles of
    /// 4.
    fn drawn(cut: Cut) -> OneByOne {
        let one_by_one = OneByOne::new(cut);
        let plan = Plan { threads: NonZeroUsize::MIN, tile: NonZeroU32::new(4).expect("not 0") };
        let mut image = Image::new(7, 5).expect("an image");
        for _ in 0..2 {
            let mut renderer = one_by_one.strategy().prepare(plan).expect("prepared");
            renderer.render(&even(50), &mut image).expect("drawn");
        }
        one_by_one
    }

    /// Catches images that are cut wrongly, and pixels that are stored one by one.
    #[test]
    fn every_piece_has_a_cost() {
        let cuts = [Cut::Pixels, Cut::Rows, Cut::Tiles, Cut::Whole].map(drawn);
        assert_eq!(cuts.each_ref().map(|cut| cut.costs(1.0).len()), [35, 5, 2 * 2, 1]);
        let remembered = |cut: &OneByOne| {
            cut.log.lock().expect("no panic").passes.iter().map(Vec::len).sum::<usize>()
        };
        assert_eq!(cuts.each_ref().map(remembered), [3, 5, 2 * 2, 1].map(|runs| 2 * runs));
        for cut in cuts {
            let sum: f64 = cut.costs(1e6).iter().sum();
            assert!((sum - 1e6).abs() < 1.0, "{sum}");
        }
    }

    #[test]
    fn a_run_is_shared_evenly() {
        assert_eq!(spread(&[8.0, 4.0, 3.0], 2, 5), [4.0, 4.0, 2.0, 2.0, 3.0]);
        assert_eq!(spread(&[8.0, 4.0], 1, 2), [8.0, 4.0]);
        assert!(spread(&[], 16, 0).is_empty());
    }

    #[test]
    fn only_the_needed_cuts_are_measured() {
        assert_eq!(Cut::for_pieces(&[Granularity::Tile, Granularity::Tile]), [Cut::Tiles]);
        assert_eq!(
            Cut::for_pieces(&[Granularity::Band, Granularity::Pixel]),
            [Cut::Pixels, Cut::Rows, Cut::Whole]
        );
        assert_eq!(Cut::for_pieces(&[Granularity::Row]), [Cut::Rows]);
    }

    /// Catches bands that are composed of their rows alone.
    #[test]
    fn pieces_that_were_not_measured_are_unknown() {
        let rows = PieceCosts { rows: vec![10.0; 4], ..PieceCosts::default() };
        assert_eq!(
            [Granularity::Pixel, Granularity::Row, Granularity::Tile, Granularity::Band]
                .map(|piece| rows.know(piece)),
            [false, true, false, false]
        );
        assert!(PieceCosts { whole: 28.0, ..rows }.know(Granularity::Band));
    }

    /// Rows cost 10 each alone, but 28 all four together: a row after another costs 6.
    #[test]
    fn bands_are_cheaper_than_their_rows() {
        let costs = PieceCosts { rows: vec![10.0; 4], whole: 28.0, ..PieceCosts::default() };
        assert_eq!(costs.of(Granularity::Band, 1), [28.0]);
        assert_eq!(costs.of(Granularity::Band, 2), [16.0, 16.0]);
        assert_eq!(costs.of(Granularity::Band, 3), [10.0, 10.0, 16.0]);
        // More threads than rows: some have nothing.
        assert_eq!(costs.of(Granularity::Band, 6), [0.0, 10.0, 10.0, 0.0, 10.0, 10.0]);
        let slower = PieceCosts { whole: 99.0, ..costs };
        assert_eq!(slower.of(Granularity::Band, 1), [40.0], "no row costs more after another");
    }

    /// The lower quartiles are 3 and 4.
    #[test]
    fn costs_are_in_proportion_to_the_quartiles_and_sum_to_the_total() {
        let passes = [vec![3.0, 11.0], vec![5.0, 4.0], vec![9.0, 6.0]];
        assert_eq!(scaled(&passes, 14.0), [6.0, 8.0]);
        assert!(scaled(&[], 14.0).is_empty());
        assert_eq!(scaled(&[vec![0.0, 0.0]], 14.0), [0.0, 0.0]);
    }
}
