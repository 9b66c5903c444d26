//! Runs of pixels: a shorter form of a time line for drawings and traces.

use rayweave_contract::Rect;
use rayweave_measure::timeline::{Piece, TimelineLane};

/// A piece, or pixels that a thread computed from left to right without a long gap between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) rect: Rect,
    pub(super) begin_ns: u64,
    pub(super) end_ns: u64,
    /// The part of this time that was spent on pieces.
    pub(super) busy_ns: u64,
    pub(super) pieces: u64,
}

/// Returns the runs of a thread. A piece of several pixels is a run of its own.
pub(super) fn of(lane: &TimelineLane, long_gap_ns: f64) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for piece in &lane.pieces {
        match runs.last_mut() {
            Some(run) if run.is_continued_by(piece, long_gap_ns) => run.append(piece),
            _ => runs.push(Run::from(piece)),
        }
    }
    runs
}

impl Run {
    fn is_continued_by(&self, &Piece { rect, begin_ns, .. }: &Piece, long_gap_ns: f64) -> bool {
        // A run of pixels has as many pieces as pixels.
        let pixels = u64::from(self.rect.width) == self.pieces && self.rect.height == 1;
        let next = (rect.x, rect.y) == (self.rect.x + self.rect.width, self.rect.y);
        let gap_ns = begin_ns.saturating_sub(self.end_ns);
        pixels && next && (rect.width, rect.height) == (1, 1) && gap_ns as f64 <= long_gap_ns
    }

    fn append(&mut self, piece: &Piece) {
        self.rect.width += 1;
        self.end_ns = piece.end_ns;
        self.busy_ns += piece.ns();
        self.pieces += 1;
    }
}

impl From<&Piece> for Run {
    fn from(piece: &Piece) -> Self {
        let &Piece { rect, begin_ns, end_ns } = piece;
        Self { rect, begin_ns, end_ns, busy_ns: piece.ns(), pieces: 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece((x, y, width, height): (u32, u32, u32, u32), begin_ns: u64, end_ns: u64) -> Piece {
        Piece { rect: Rect { x, y, width, height }, begin_ns, end_ns }
    }

    /// Catches runs beyond the end of a row, over a long gap, backwards, and of larger pieces.
    #[test]
    fn pixels_that_follow_each_other_are_one_run() {
        let pieces = vec![
            piece((3, 0, 1, 1), 0, 10),
            piece((4, 0, 1, 1), 15, 20),
            piece((5, 0, 1, 1), 20, 29),
            // After a gap of 6, in another row, to the left, and larger.
            piece((6, 0, 1, 1), 35, 40),
            piece((7, 1, 1, 1), 40, 41),
            piece((6, 1, 1, 1), 41, 42),
            piece((7, 1, 2, 1), 42, 43),
            piece((9, 1, 1, 1), 43, 44),
        ];
        let runs = of(&TimelineLane { name: None, pieces: pieces.clone() }, 5.0);
        let rect = Rect { x: 3, y: 0, width: 3, height: 1 };
        assert_eq!(runs[0], Run { rect, begin_ns: 0, end_ns: 29, busy_ns: 24, pieces: 3 });
        assert_eq!(runs[1..], pieces[3..].iter().map(Run::from).collect::<Vec<_>>());
    }
}
