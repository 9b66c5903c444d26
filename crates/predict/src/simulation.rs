//! A discrete-event simulation of a strategy: replays the costs of its pieces under its policy.
//!
//! The model is simpler than a machine. All threads compute equally fast, each on a core of its
//! own, as does the owner of the image that pieces are sent to. A lock is granted in the order of
//! requests. Memory bandwidth is unlimited.

use crate::scheduler::{Scheduler, Source};
use rayweave_contract::{Output, Policy};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::ops::Range;

#[cfg(test)]
mod tests;

/// The costs of a strategy beside the work, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Overheads {
    /// The time before the first thread begins and after the last has ended.
    pub start: f64,
    /// The time from the begin of one thread to that of the next.
    pub next_start: f64,
    /// The time for each piece, on the thread that computes it.
    pub piece: f64,
    /// The time to take pieces from the shared queue.
    pub take: Access,
    /// The time to copy a piece into the image under the lock, or to receive it.
    pub deliver: Access,
    /// The time to take pieces from another thread.
    pub steal: f64,
}

/// The cost of a critical section, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Access {
    /// The time in the critical section.
    pub hold: f64,
    /// The additional time if another thread was in it last.
    pub handover: f64,
}

/// A simulated rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedRender {
    /// The time of the rendering, in nanoseconds.
    pub time: f64,
    /// The time that each thread computed, in nanoseconds.
    pub computed: Vec<f64>,
}

/// Simulates a rendering by `threads` threads, or 1 if it is 0. `pieces` are the nanoseconds of
/// each piece, in the order of their numbers; if a piece is a band there is one for each thread.
///
/// When two events have the same time, that of the lower thread comes first, so that the same input
/// gives the same result.
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
    /// The queue that pieces are taken from.
    shared_queue: Shared,
    /// The image that they are copied into.
    image: Shared,
    /// The pieces that each thread has taken and not yet computed.
    local_queues: Vec<Range<usize>>,
    computed: Vec<f64>,
    events: BinaryHeap<Reverse<Event>>,
    /// The threads that found nothing to take. They try again when another thread leaves pieces in
    /// its queue.
    idle: Vec<usize>,
    /// The latest end of a thread so far.
    end: f64,
}

impl Simulation<'_> {
    fn at(&mut self, time: f64, thread: usize, step: Step) {
        self.events.push(Reverse(Event { time, thread, step }));
    }

    /// Takes the next chunk for a thread whose local queue is empty.
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
        if chunk.leaves_rest {
            for other in std::mem::take(&mut self.idle) {
                self.at(begin, other, Step::Take);
            }
        }
        self.local_queues[thread] = chunk.pieces;
        self.compute(begin, thread);
    }

    /// Computes the pieces of a thread's local queue, up to its next critical section.
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

    /// Delivers a piece that a thread has computed.
    fn deliver(&mut self, time: f64, thread: usize) {
        let delivered = self.image.access(time, thread, &self.overheads.deliver);
        self.end = self.end.max(delivered);
        // The owner of the image receives a piece while the sender computes on.
        let free = if self.policy.output == Output::Channel { time } else { delivered };
        self.compute(free, thread);
    }
}

/// A critical section.
#[derive(Debug, Default)]
struct Shared {
    free: f64,
    last: Option<usize>,
}

impl Shared {
    /// Returns the time at which `thread`, which asks at `time`, leaves the critical section.
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
