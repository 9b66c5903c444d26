//! What a strategy's threads cost it here, as a simulation needs it: from outside, on synthetic work.

use crate::overhead::{of_pixels, step};
use crate::sheet::{Columns, Sheet};
use crate::statistics::median;
use crate::synthetic::Synthetic;
use rayweave_core::strategy::{Dealing, Delivery, Piece, Rule};
use rayweave_core::{Renderer, Strategy};
use rayweave_predict::{Access, Overheads};
use std::num::NonZeroUsize;

/// Times that everything is measured; the median counts.
const REPETITIONS: usize = 15;

/// A piece long enough for every thread to get one, in nanoseconds.
const LONG_PIECE: f64 = 200e3;

/// Pieces of the rendering of which half must be stolen, and nanoseconds of each.
const STOLEN: (u32, f64) = (64, 10e3);

/// Measures the overheads of `strategies`, taking turns, on one and on `threads` threads.
///
/// # Errors
///
/// The reference, which steps are timed with, or one of the strategies fails: what it says.
pub fn calibrate(
    reference: &dyn Strategy,
    strategies: &[&dyn Strategy],
    threads: NonZeroUsize,
    mut progress: impl FnMut(f64),
) -> Result<Vec<Overheads>, String> {
    let mut sheets = Sheets::new(step(reference)?, threads)?;
    let mut times = vec![Vec::new(); strategies.len()];
    for repetition in 0..REPETITIONS {
        progress(repetition as f64 / REPETITIONS as f64);
        for (&strategy, times) in strategies.iter().zip(&mut times) {
            let mut one = of_pixels(strategy, NonZeroUsize::MIN)?;
            let mut all = of_pixels(strategy, threads)?;
            times.push(sheets.times(strategy.rule(), &mut *one, &mut *all)?);
        }
    }
    Ok(strategies.iter().zip(&times).map(|(s, times)| overheads(s.rule(), &Times::median(times))).collect())
}

/// What is rendered.
struct Sheets {
    columns: Columns,
    single: Sheet,
    /// A long piece for each thread, but for the first alone, and for all.
    long_one: Sheet,
    long_all: Sheet,
    /// The same load spread evenly, and in the latter half of the pieces.
    spread: Sheet,
    late: Sheet,
    threads: u32,
}

impl Sheets {
    fn new(step_ns: f64, threads: NonZeroUsize) -> Result<Self, String> {
        let steps = |ns: f64| (ns / step_ns).round() as u32;
        let threads = u32::try_from(threads.get()).unwrap_or(u32::MAX);
        let (long, (pieces, ns)) = (steps(LONG_PIECE), STOLEN);
        let late = steps(ns);
        Ok(Self {
            columns: Columns::new()?,
            single: Sheet::column(1, 0)?,
            long_one: Sheet::column(1, long)?,
            long_all: Sheet::column(threads, long)?,
            spread: Sheet::column(pieces, steps(ns / 2.0))?,
            late: Sheet::new(Synthetic(move |_, y| if y < pieces / 2 { 0 } else { late }), 1, pieces)?,
            threads,
        })
    }

    fn times(&mut self, rule: Rule, one: &mut dyn Renderer, all: &mut dyn Renderer) -> Result<Times, String> {
        let mut times = Times { start: self.single.time(one)?, ..Times::default() };
        if rule.piece != Piece::Band {
            times.piece_one = self.columns.dispatch(one)?;
            times.piece_all = self.columns.dispatch(all)?;
        }
        if self.threads > 1 {
            // Whoever begins later ends later.
            let alone = self.long_one.time(one)?;
            times.next_start = (self.long_all.time(all)? - alone) / f64::from(self.threads - 1);
            if matches!(rule.dealing, Dealing::Stealing | Dealing::Halving) {
                times.steal = self.late.time(all)? - self.spread.time(all)?;
            }
        }
        Ok(times)
    }
}

/// In nanoseconds.
#[derive(Clone, Copy, Debug, Default)]
struct Times {
    /// One thread renders next to nothing.
    start: f64,
    /// From one thread's beginning to the next's.
    next_start: f64,
    /// For each piece, on one thread.
    piece_one: f64,
    /// For each piece, on all.
    piece_all: f64,
    /// To take pieces from another thread.
    steal: f64,
}

impl Times {
    /// Of each figure by itself; what comes out below 0 is noise.
    fn median(times: &[Self]) -> Self {
        let of =
            |of: fn(&Self) -> f64| median(&times.iter().map(of).collect::<Vec<_>>()).unwrap_or(0.0).max(0.0);
        Self {
            start: of(|times| times.start),
            next_start: of(|times| times.next_start),
            piece_one: of(|times| times.piece_one),
            piece_all: of(|times| times.piece_all),
            steal: of(|times| times.steal),
        }
    }
}

/// From outside nothing tells what of a piece's dispatch one thread at a time does. Where all threads share something,
/// that much of it is taken for it as did not become faster by more threads, and what became slower is the handover.
fn overheads(rule: Rule, times: &Times) -> Overheads {
    let Times { start, next_start, piece_one, piece_all, steal } = *times;
    let all = Overheads { start, next_start, piece: piece_one, steal, ..Overheads::default() };
    let access = |pieces: f64| Access {
        hold: piece_one.min(piece_all) * pieces,
        handover: (piece_all - piece_one).max(0.0) * pieces,
    };
    let piece = (piece_one - piece_all).max(0.0);
    match (rule.delivery, rule.dealing) {
        (Delivery::Locked | Delivery::Sent, _) => Overheads { deliver: access(1.0), piece, ..all },
        (Delivery::InPlace, Dealing::Shared { chunk }) => {
            Overheads { take: access(chunk as f64), piece, ..all }
        }
        (Delivery::InPlace, _) => all,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: Times = Times { start: 1.0, next_start: 2.0, piece_one: 10.0, piece_all: 14.0, steal: 3.0 };

    fn of(dealing: Dealing, delivery: Delivery, piece_all: f64) -> Overheads {
        overheads(Rule { piece: Piece::Row, dealing, delivery }, &Times { piece_all, ..TIMES })
    }

    /// Catches a dispatch that is counted twice, or in the wrong place.
    #[test]
    fn what_is_shared_takes_what_threads_do_not_speed_up() {
        let all = Overheads { start: 1.0, next_start: 2.0, piece: 10.0, steal: 3.0, ..Overheads::default() };
        assert_eq!(of(Dealing::Equal, Delivery::InPlace, 14.0), all);
        assert_eq!(of(Dealing::Stealing, Delivery::InPlace, 6.0), all);
        let take = Access { hold: 20.0, handover: 8.0 };
        let shared = Dealing::Shared { chunk: 2 };
        assert_eq!(of(shared, Delivery::InPlace, 14.0), Overheads { piece: 0.0, take, ..all });
        let deliver = Access { hold: 6.0, handover: 0.0 };
        assert_eq!(of(shared, Delivery::Locked, 6.0), Overheads { piece: 4.0, deliver, ..all });
        assert_eq!(of(Dealing::Equal, Delivery::Sent, 6.0), Overheads { piece: 4.0, deliver, ..all });
    }

    #[test]
    fn medians_are_figure_by_figure_and_never_below_nothing() {
        let times = [1.0, 2.0, 9.0].map(|start| Times { start, steal: start - 5.0, ..TIMES });
        let median = Times::median(&times);
        assert_eq!((median.start, median.steal, median.piece_one), (2.0, 0.0, 10.0));
    }
}
