//! Assigns pieces to threads: each [`Scheduling`] as a function that returns a thread's next chunk.

use rayweave_contract::Scheduling;
use std::collections::VecDeque;
use std::ops::Range;

/// The pieces that a thread takes at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    /// The pieces, which no other thread gets.
    pub(crate) pieces: Range<usize>,
    pub(crate) source: Source,
    /// True if the thread leaves pieces in its queue that others can steal.
    pub(crate) leaves_rest: bool,
}

/// The owner of the pieces before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The thread itself.
    Own,
    /// The queue shared by all threads.
    Shared,
    /// Another thread.
    Stolen,
}

/// The remaining pieces, by owner.
#[derive(Debug)]
pub(crate) enum Scheduler {
    Static(Vec<Range<usize>>),
    Dynamic { left: Range<usize>, chunk: usize },
    Guided { left: Range<usize>, threads: usize },
    WorkStealing(Vec<Range<usize>>),
    RecursiveSplit(Vec<VecDeque<Part>>),
}

/// A range with rayon's budget of splits, which every split halves.
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

    /// Returns the next chunk of `thread`; `None` if there is none at the moment.
    pub(crate) fn next(&mut self, thread: usize) -> Option<Chunk> {
        let mut leaves_rest = false;
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
                leaves_rest = !queues[thread].is_empty();
                chunk
            }
        };
        (!pieces.is_empty()).then_some(Chunk { pieces, source, leaves_rest })
    }
}

/// Returns one of the thread's own pieces, or one of the second half of the largest share.
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

/// Returns the thread's latest part, or the oldest of the next thread that has one. The part is
/// halved as often as it may be; the right halves go to the thread's queue. This is rayon's way.
fn halve(queues: &mut [VecDeque<Part>], thread: usize) -> Option<(Range<usize>, Source)> {
    let threads = queues.len();
    let (mut part, source) = match queues[thread].pop_back() {
        Some(part) => (part, Source::Own),
        None => {
            let others = (1..threads).map(|distance| (thread + distance) % threads);
            let mut part = others.filter_map(|other| queues[other].pop_front()).next()?;
            // A thread is idle, so smaller parts are needed again. The factor 2 makes up for the
            // division in the loop below.
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
