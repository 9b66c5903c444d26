//! Measures the cost of recording a piece.

use super::{TimeRecorder, TimelineLane};
use crate::statistics::median;
use rayweave_contract::{Tile, Work};
use std::time::Instant;

/// The time that recording a piece adds to a rendering, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RecordingCost {
    /// The time added to the piece itself, by the two clock readings around the work.
    pub inside_ns: f64,
    /// The time added between the piece and the next.
    pub outside_ns: f64,
}

/// The number of batches. Their median is robust against interference.
const BATCHES: usize = 21;

/// The number of pieces of a batch.
const PIECES: u32 = 2000;

struct Nothing;

impl Work for Nothing {
    fn render(&self, _: &mut Tile<'_>) {}
}

impl RecordingCost {
    /// Measures the cost on this machine with work that does nothing. It takes a few milliseconds.
    #[must_use]
    pub fn here() -> Self {
        let lanes: Vec<TimelineLane> = (0..BATCHES).filter_map(|_| batch()).collect();
        let per_piece = |of: fn(&TimelineLane) -> u64| {
            let means: Vec<f64> =
                lanes.iter().map(|lane| of(lane) as f64 / f64::from(PIECES)).collect();
            median(&means).unwrap_or(0.0)
        };
        Self {
            inside_ns: per_piece(TimelineLane::busy_ns),
            outside_ns: per_piece(|lane| lane.gaps_ns().sum()),
        }
    }
}

fn batch() -> Option<TimelineLane> {
    let recorder = TimeRecorder::new(&Nothing, 1, PIECES as usize);
    let begin = Instant::now();
    (0..PIECES).for_each(|x| recorder.render(&mut Tile::pixel(x, 0, &mut [0.0; 3])));
    recorder.finish(begin, Instant::now()).lanes.pop()
}
