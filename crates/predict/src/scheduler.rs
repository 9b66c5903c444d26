//! Who gets which pieces: each [`Scheduling`] as an answer to a thread that asks for more.

use rayweave_contract::Scheduling;
use std::collections::VecDeque;
use std::ops::Range;

/// What a thread got.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    /// Nobody else gets these any more.
    pub(crate) pieces: Range<usize>,
    pub(crate) source: Source,
    /// Whether others find something to take that was not there before.
    pub(crate) laid_out: bool,
}

/// Where pieces came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// They were the thread's own.
    Own,
    /// What all threads take from.
    Shared,
    /// They were another thread's.
    Stolen,
}

/// Pieces that are left, by whom they belong to.
#[derive(Debug)]
pub(crate) enum Scheduler {
    Static(Vec<Range<usize>>),
    Dynamic { left: Range<usize>, chunk: usize },
    Guided { left: Range<usize>, threads: usize },
    WorkStealing(Vec<Range<usize>>),
    RecursiveSplit(Vec<VecDeque<Part>>),
}

/// A range that may still be halved so often.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pieces: Range<usize>,
    splits: usize,
}

impl Scheduler {
    pub(crate) fn new(scheduling: Scheduling, threads: usize, pieces: usize) -> Self {
        let shares =
            || (0..threads).map(|i| pieces * i / threads..pieces * (i + 1) / threads).collect();
        match scheduling {
            Scheduling::Static => Self::Static(shares()),
            Scheduling::Dynamic { chunk } => Self::Dynamic { left: 0..pieces, chunk: chunk.max(1) },
            Scheduling::Guided => Self::Guided { left: 0..pieces, threads },
            Scheduling::WorkStealing => Self::WorkStealing(shares()),
            Scheduling::RecursiveSplit => {
                let mut queues = vec![VecDeque::new(); threads];
                queues[0].push_back(Part { pieces: 0..pieces, splits: threads });
                Self::RecursiveSplit(queues)
            }
        }
    }

    /// What `thread` gets when it asks; `None` if there is nothing for it at the moment.
    pub(crate) fn next(&mut self, thread: usize) -> Option<Chunk> {
        let mut laid_out = false;
        let (pieces, source) = match self {
            Self::Static(shares) => (std::mem::take(&mut shares[thread]), Source::Own),
            Self::Dynamic { left, chunk } => (take_front(left, *chunk), Source::Shared),
            Self::Guided { left, threads } => {
                let count = left.len().div_ceil(*threads);
                (take_front(left, count), Source::Shared)
            }
            Self::WorkStealing(shares) => steal(shares, thread),
            Self::RecursiveSplit(queues) => {
                let chunk = halve(queues, thread)?;
                laid_out = !queues[thread].is_empty();
                chunk
            }
        };
        (!pieces.is_empty()).then_some(Chunk { pieces, source, laid_out })
    }
}

/// One of the thread's own, or the latter half of what the richest has.
fn steal(shares: &mut [Range<usize>], thread: usize) -> (Range<usize>, Source) {
    let mut source = Source::Own;
    if shares[thread].is_empty()
        && let Some(victim) = (0..shares.len()).rev().max_by_key(|&other| shares[other].len())
    {
        let middle = shares[victim].start + shares[victim].len() / 2;
        shares[thread] = middle..shares[victim].end;
        shares[victim].end = middle;
        source = Source::Stolen;
    }
    (take_front(&mut shares[thread], 1), source)
}

/// As rayon does: the thread's latest part, or the oldest of the next thread that has one, halved
/// as long as it may be; the halves at the right are there for others.
fn halve(queues: &mut [VecDeque<Part>], thread: usize) -> Option<(Range<usize>, Source)> {
    let threads = queues.len();
    let (mut part, source) = match queues[thread].pop_back() {
        Some(part) => (part, Source::Own),
        None => {
            let others = (1..threads).map(|distance| (thread + distance) % threads);
            let mut part = others.filter_map(|other| queues[other].pop_front()).next()?;
            // Somebody is idle, so smaller parts are wanted again; one more, for the halving that
            // follows.
            part.splits = 2 * threads.max(part.splits / 2);
            (part, Source::Stolen)
        }
    };
    while part.pieces.len() >= 2 && part.splits > 0 {
        part.splits /= 2;
        let middle = part.pieces.start + part.pieces.len() / 2;
        queues[thread].push_back(Part { pieces: middle..part.pieces.end, splits: part.splits });
        part.pieces.end = middle;
    }
    Some((part.pieces, source))
}

fn take_front(left: &mut Range<usize>, count: usize) -> Range<usize> {
    let end = left.start.saturating_add(count).min(left.end);
    let taken = left.start..end;
    left.start = end;
    taken
}
