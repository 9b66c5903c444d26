//! A discrete-event simulation of a strategy: the costs of its pieces are replayed under its policy.
//!
//! What it leaves out: all threads compute equally fast, each on a core of its own, as does the
//! owner of the image that pieces are sent to; whoever waits for a lock gets it in the order of
//! asking; memory has any bandwidth.

use crate::scheduler::{Scheduler, Source};
use rayweave_contract::{Output, Policy};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::ops::Range;

#[cfg(test)]
mod tests;

/// What spreading costs beside the work, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Overheads {
    /// Before the first thread begins, and after the last has ended.
    pub start: f64,
    /// From one thread's beginning to the next one's.
    pub next_start: f64,
    /// For each piece, on the thread that computes it.
    pub piece: f64,
    /// To take pieces from what all threads share.
    pub take: Access,
    /// To put a piece into the image under the lock, or to receive it.
    pub deliver: Access,
    /// To take pieces from another thread.
    pub steal: f64,
}

/// The cost of something that one thread at a time has, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Access {
    /// To have it.
    pub hold: f64,
    /// More, where another thread had it last.
    pub handover: f64,
}

/// A simulated rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedRender {
    /// What the rendering took, in nanoseconds.
    pub time: f64,
    /// What each thread computed, in nanoseconds.
    pub computed: Vec<f64>,
}

/// The rendering of pieces that take `pieces` nanoseconds each, in the order of their numbers, by
/// `threads` threads; 0 of them are taken for 1. Where a piece is a band there is one for each
/// thread.
///
/// Of equal times the lower thread's comes first, so that the same input gives the same result.
#[must_use]
pub fn simulate(
    policy: Policy,
    threads: usize,
    pieces: &[f64],
    overheads: &Overheads,
) -> SimulatedRender {
    let threads = threads.max(1);
    let mut simulation = Simulation {
        policy,
        pieces,
        overheads,
        scheduler: Scheduler::new(policy.scheduling, threads, pieces.len()),
        shared_queue: Shared::default(),
        image: Shared::default(),
        local_queues: vec![0..0; threads],
        computed: vec![0.0; threads],
        events: BinaryHeap::new(),
        idle: Vec::new(),
        end: 0.0,
    };
    for thread in 0..threads {
        simulation.at(thread as f64 * overheads.next_start, thread, Step::Take);
    }
    while let Some(Reverse(Event { time, thread, step })) = simulation.events.pop() {
        match step {
            Step::Take => simulation.take(time, thread),
            Step::Deliver => simulation.deliver(time, thread),
        }
    }
    SimulatedRender { time: overheads.start + simulation.end, computed: simulation.computed }
}

struct Simulation<'a> {
    policy: Policy,
    pieces: &'a [f64],
    overheads: &'a Overheads,
    scheduler: Scheduler,
    /// What pieces are taken from.
    shared_queue: Shared,
    /// Where they are put.
    image: Shared,
    /// What each thread has taken, and not yet computed.
    local_queues: Vec<Range<usize>>,
    computed: Vec<f64>,
    events: BinaryHeap<Reverse<Event>>,
    /// Threads that found nothing to take, and try again when something is laid out.
    idle: Vec<usize>,
    /// When the last thread ended, so far.
    end: f64,
}

impl Simulation<'_> {
    fn at(&mut self, time: f64, thread: usize, step: Step) {
        self.events.push(Reverse(Event { time, thread, step }));
    }

    /// A thread has nothing in hand and asks for more.
    fn take(&mut self, time: f64, thread: usize) {
        let Some(chunk) = self.scheduler.next(thread) else {
            self.end = self.end.max(time);
            self.idle.push(thread);
            return;
        };
        let begin = match chunk.source {
            Source::Own => time,
            Source::Shared => self.shared_queue.access(time, thread, &self.overheads.take),
            Source::Stolen => time + self.overheads.steal,
        };
        if chunk.laid_out {
            for other in std::mem::take(&mut self.idle) {
                self.at(begin, other, Step::Take);
            }
        }
        self.local_queues[thread] = chunk.pieces;
        self.compute(begin, thread);
    }

    /// A thread computes what it has in hand, up to its next meeting with the others.
    fn compute(&mut self, mut time: f64, thread: usize) {
        while let Some(piece) = self.local_queues[thread].next() {
            self.computed[thread] += self.pieces[piece];
            time += self.overheads.piece + self.pieces[piece];
            if self.policy.output != Output::InPlace {
                return self.at(time, thread, Step::Deliver);
            }
        }
        self.at(time, thread, Step::Take);
    }

    /// A thread has computed a piece.
    fn deliver(&mut self, time: f64, thread: usize) {
        let delivered = self.image.access(time, thread, &self.overheads.deliver);
        self.end = self.end.max(delivered);
        // A piece that is sent is the owner's business.
        let free = if self.policy.output == Output::Channel { time } else { delivered };
        self.compute(free, thread);
    }
}

/// Something that one thread at a time has.
#[derive(Debug, Default)]
struct Shared {
    free: f64,
    last: Option<usize>,
}

impl Shared {
    /// When `thread`, asking at `time`, has had it.
    fn access(&mut self, time: f64, thread: usize, cost: &Access) -> f64 {
        let handed_over = self.last.replace(thread).is_some_and(|last| last != thread);
        let handover = if handed_over { cost.handover } else { 0.0 };
        self.free = self.free.max(time) + cost.hold + handover;
        self.free
    }
}

#[derive(Clone, Copy, Debug)]
struct Event {
    time: f64,
    thread: usize,
    step: Step,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Take,
    Deliver,
}

impl Ord for Event {
    fn cmp(&self, other: &Self) -> Ordering {
        self.time.total_cmp(&other.time).then(self.thread.cmp(&other.thread))
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Event {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Event {}
