//! Where the thread-time of a rendering went, and so what of its efficiency is lost to what.
//!
//! A rendering that takes `w` on `n` threads has a thread-time of `n w`. A thread computes, is
//! between two pieces, has not begun yet, or is done and waits for the others: an [`TimeBreakdown`] puts
//! each nanosecond into one of these. What a strategy loses is its thread-time less the time that
//! the sequential rendering takes, and the [`LostTime`] are the differences between three accounts:
//! of the sequential rendering, of the strategy on one thread, and on all. Since an breakdown leaves
//! nothing out, they add up to that exactly.

use crate::timeline::{RecordingCost, Timeline, TimelineLane};

/// Where the thread-time of one rendering went; in nanoseconds, over all threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeBreakdown {
    /// The threads that there are to compute on.
    pub threads: usize,
    /// From the beginning of the rendering to its end.
    pub wall_ns: f64,
    /// Pieces computed.
    pub busy_ns: f64,
    /// From each piece to the thread's next.
    pub dispatch_ns: f64,
    /// From a thread's last piece to the last of all. A thread without any waits from the first
    /// piece of all on.
    pub waiting_ns: f64,
    /// Before a thread's first piece, and after the last of all.
    pub serial_ns: f64,
}

/// Why thread-time is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// More is computed: what the sequential rendering's tiles share, smaller pieces compute again.
    /// Calls of the work, and the memory that they find cold, are in it too.
    Redundant,
    /// The same pieces take longer on all threads than on one: memory, clock rate, shared cores,
    /// other programs.
    Slowdown,
    /// From piece to piece, as long as a single thread takes for it.
    Dispatch,
    /// From piece to piece, what it takes longer with several threads: locks, a shared counter.
    Contention,
    /// Threads that are done while others compute.
    Imbalance,
    /// Before threads begin and after they have ended.
    Serial,
}

impl Cause {
    /// In the order of the tables.
    pub const ALL: [Self; 6] = [
        Self::Redundant,
        Self::Slowdown,
        Self::Dispatch,
        Self::Contention,
        Self::Imbalance,
        Self::Serial,
    ];
}

/// What is lost to each cause, in nanoseconds of thread-time. Negative where something is gained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostTime([f64; Cause::ALL.len()]);

/// A thread's begin and end of computing, what it recorded taken off.
struct Span {
    begin: f64,
    end: f64,
    busy: f64,
}

impl TimeBreakdown {
    /// The breakdown of a rendering on `threads` threads, or on as many as computed if these are
    /// more, without what it cost to record.
    ///
    /// Each piece of a thread is taken to have begun earlier by the cost of those that it recorded
    /// before, so the rendering ends earlier by what that brings the last of all forward.
    #[must_use]
    pub fn of(timeline: &Timeline, threads: usize, cost: RecordingCost) -> Self {
        let spans: Vec<Span> =
            timeline.lanes.iter().filter_map(|lane| Span::of(lane, cost)).collect();
        let threads = threads.max(spans.len()).max(1);
        let recorded_wall = timeline.wall_ns as f64;
        let recorded_last =
            timeline.lanes.iter().filter_map(|lane| lane.pieces.last()).map(|p| p.end_ns).max();
        let Some(recorded_last) = recorded_last.map(|ns| ns as f64) else {
            // Nobody computed.
            let serial_ns = threads as f64 * recorded_wall;
            let (busy_ns, dispatch_ns, waiting_ns) = (0.0, 0.0, 0.0);
            return Self {
                threads,
                wall_ns: recorded_wall,
                busy_ns,
                dispatch_ns,
                waiting_ns,
                serial_ns,
            };
        };
        let first = spans.iter().map(|span| span.begin).fold(f64::INFINITY, f64::min);
        let last = spans.iter().map(|span| span.end).fold(0.0, f64::max);
        let wall_ns = recorded_wall - (recorded_last - last);
        let idle = (threads - spans.len()) as f64;
        let sum = |of: &dyn Fn(&Span) -> f64| spans.iter().map(of).sum::<f64>();
        Self {
            threads,
            wall_ns,
            busy_ns: sum(&|span| span.busy),
            dispatch_ns: sum(&|span| span.end - span.begin - span.busy),
            waiting_ns: sum(&|span| last - span.end) + idle * (last - first),
            serial_ns: sum(&|span| span.begin) + idle * first + threads as f64 * (wall_ns - last),
        }
    }

    /// Threads times time, in nanoseconds: the sum of all that the breakdown has.
    #[must_use]
    pub fn thread_time_ns(&self) -> f64 {
        self.threads as f64 * self.wall_ns
    }
}

impl Span {
    fn of(lane: &TimelineLane, cost: RecordingCost) -> Option<Self> {
        let (first, last) = (lane.pieces.first()?, lane.pieces.last()?);
        let pieces = lane.pieces.len() as f64;
        let inside = pieces * cost.inside_ns;
        let begin = first.begin_ns as f64;
        // What is recorded of the last piece after its end delays no other.
        let end = last.end_ns as f64 - inside - (pieces - 1.0) * cost.outside_ns;
        Some(Self { begin, end, busy: lane.busy_ns() as f64 - inside })
    }
}

impl LostTime {
    /// What a strategy loses `together`, on all its threads, by what it does `alone`, on one, and
    /// by what the `sequential` rendering does.
    #[must_use]
    pub fn new(
        sequential: &TimeBreakdown,
        alone: &TimeBreakdown,
        together: &TimeBreakdown,
    ) -> Self {
        Self(Cause::ALL.map(|cause| match cause {
            Cause::Redundant => alone.busy_ns - sequential.busy_ns,
            Cause::Slowdown => together.busy_ns - alone.busy_ns,
            Cause::Dispatch => alone.dispatch_ns - sequential.dispatch_ns,
            Cause::Contention => together.dispatch_ns - alone.dispatch_ns,
            Cause::Imbalance => together.waiting_ns - sequential.waiting_ns,
            Cause::Serial => together.serial_ns - sequential.serial_ns,
        }))
    }

    /// To one cause.
    #[must_use]
    pub fn to(&self, cause: Cause) -> f64 {
        self.0[cause as usize]
    }

    /// To all of them.
    #[must_use]
    pub fn total_ns(&self) -> f64 {
        self.0.iter().sum()
    }

    /// The cause to which most is lost.
    #[must_use]
    pub fn largest(&self) -> Cause {
        let larger = |a: &Cause, b: &Cause| self.to(*a).total_cmp(&self.to(*b));
        // `max_by` of no causes at all.
        Cause::ALL.into_iter().max_by(larger).unwrap_or(Cause::Serial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timeline::Piece;
    use rayweave_contract::Rect;

    const FREE: RecordingCost = RecordingCost { inside_ns: 0.0, outside_ns: 0.0 };

    fn timeline(wall_ns: u64, lanes: &[&[(u64, u64)]]) -> Timeline {
        let piece = |&(begin_ns, end_ns): &(u64, u64)| Piece {
            rect: Rect { x: 0, y: 0, width: 1, height: 1 },
            begin_ns,
            end_ns,
        };
        let lane = |pieces: &&[(u64, u64)]| TimelineLane {
            name: None,
            pieces: pieces.iter().map(piece).collect(),
        };
        Timeline { wall_ns, lanes: lanes.iter().map(lane).collect() }
    }

    /// Two threads: one from 10 to 90 with a gap of 5, the other from 20 to 60 with gaps of 1 and
    /// 3.
    fn uneven() -> Timeline {
        timeline(100, &[&[(10, 50), (55, 90)], &[(20, 30), (31, 40), (43, 60)]])
    }

    #[test]
    fn every_nanosecond_is_somewhere() {
        let breakdown = TimeBreakdown::of(&uneven(), 2, FREE);
        let expected = TimeBreakdown {
            threads: 2,
            wall_ns: 100.0,
            busy_ns: 75.0 + 36.0,
            dispatch_ns: 5.0 + 4.0,
            waiting_ns: 30.0,
            serial_ns: 10.0 + 20.0 + 2.0 * 10.0,
        };
        assert_eq!(breakdown, expected);
        assert_eq!(breakdown.thread_time_ns(), 111.0 + 9.0 + 30.0 + 50.0);
    }

    /// Catches idle threads that are forgotten, or that wait before anybody can have a piece.
    #[test]
    fn a_thread_without_a_piece_waits_from_the_first_to_the_last() {
        let breakdown = TimeBreakdown::of(&uneven(), 4, FREE);
        assert_eq!(
            (breakdown.waiting_ns, breakdown.serial_ns),
            (30.0 + 2.0 * 80.0, 50.0 + 2.0 * (10.0 + 10.0))
        );
        assert_eq!((breakdown.busy_ns, breakdown.dispatch_ns), (111.0, 9.0));
        // More threads than there should be are all there.
        assert_eq!(TimeBreakdown::of(&uneven(), 1, FREE), TimeBreakdown::of(&uneven(), 2, FREE));
    }

    #[test]
    fn a_rendering_without_a_piece_is_nothing_but_ends() {
        let breakdown = TimeBreakdown::of(&timeline(7, &[]), 3, FREE);
        assert_eq!((breakdown.thread_time_ns(), breakdown.serial_ns), (21.0, 21.0));
    }

    /// Catches a cost that is taken off twice, for the last piece, or not off the whole.
    #[test]
    fn the_cost_of_recording_is_taken_off() {
        let breakdown =
            TimeBreakdown::of(&uneven(), 2, RecordingCost { inside_ns: 2.0, outside_ns: 1.0 });
        // The threads end 5 and 8 earlier, and the rendering with the first of them.
        let expected = TimeBreakdown {
            threads: 2,
            wall_ns: 95.0,
            busy_ns: 111.0 - 2.0 * 5.0,
            dispatch_ns: 9.0 - 1.0 - 2.0,
            waiting_ns: 85.0 - 52.0,
            serial_ns: 50.0,
        };
        assert_eq!(breakdown, expected);
        let sum =
            breakdown.busy_ns + breakdown.dispatch_ns + breakdown.waiting_ns + breakdown.serial_ns;
        assert_eq!(breakdown.thread_time_ns(), sum);
    }

    #[test]
    fn losses_are_the_differences_and_add_up() {
        let sequential = TimeBreakdown::of(&timeline(90, &[&[(2, 40), (41, 88)]]), 1, FREE);
        let alone = TimeBreakdown::of(&timeline(120, &[&[(5, 40), (42, 80), (84, 110)]]), 1, FREE);
        let together = TimeBreakdown::of(&uneven(), 2, FREE);
        let losses = LostTime::new(&sequential, &alone, &together);
        let expected = [
            (Cause::Redundant, 99.0 - 85.0),
            (Cause::Slowdown, 111.0 - 99.0),
            (Cause::Dispatch, 6.0 - 1.0),
            (Cause::Contention, 9.0 - 6.0),
            (Cause::Imbalance, 30.0),
            (Cause::Serial, 50.0 - 4.0),
        ];
        assert_eq!(Cause::ALL.map(|cause| (cause, losses.to(cause))), expected);
        assert_eq!(losses.total_ns(), 2.0 * 100.0 - 90.0);
        assert_eq!(losses.largest(), Cause::Serial);
    }

    #[test]
    fn sequential_loses_nothing_against_itself_but_the_other_threads() {
        let timeline = timeline(90, &[&[(2, 40), (41, 88)]]);
        let one = TimeBreakdown::of(&timeline, 1, FREE);
        assert_eq!(LostTime::new(&one, &one, &one).total_ns(), 0.0);
        let three = LostTime::new(&one, &one, &TimeBreakdown::of(&timeline, 3, FREE));
        assert_eq!((three.to(Cause::Imbalance), three.to(Cause::Serial)), (2.0 * 86.0, 2.0 * 4.0));
        assert_eq!(three.total_ns(), 2.0 * 90.0);
    }
}
