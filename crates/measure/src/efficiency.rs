//! The thread-time of a rendering, split into activities and causes of lost efficiency.
//!
//! A rendering that takes `w` on `n` threads has a thread-time of `n w`. At any time a thread
//! computes a piece, is between two pieces, has not begun yet, or has finished and waits for the
//! others. A [`TimeBreakdown`] counts each nanosecond once. A strategy loses its thread-time less
//! the time of the sequential rendering. [`LostTime`] splits that by cause: each cause is the
//! difference between two of three breakdowns, of the sequential rendering, of the strategy on one
//! thread and of the strategy on all threads. A breakdown leaves nothing out, so the causes add up
//! to the loss exactly.

use crate::timeline::{RecordingCost, Timeline, TimelineLane};
use serde::{Serialize, Serializer};

/// The thread-time of one rendering by activity, in nanoseconds over all threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeBreakdown {
    /// The number of threads available to the rendering.
    pub threads: usize,
    /// The time from the beginning of the rendering to its end.
    pub wall_ns: f64,
    /// The time in pieces.
    pub busy_ns: f64,
    /// The time from each piece to the next of the same thread.
    pub dispatch_ns: f64,
    /// The time from a thread's last piece to the last of all. A thread without a piece waits from
    /// the first piece of all on.
    pub waiting_ns: f64,
    /// The time before a thread's first piece, and after the last of all.
    pub serial_ns: f64,
}

/// A cause of lost thread-time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Cause {
    /// More is computed: smaller pieces compute again what the sequential rendering's tiles share.
    /// It includes calls of the work and cold memory.
    Redundant,
    /// The same pieces take longer on all threads than on one: memory, clock rate, shared cores,
    /// other programs.
    Slowdown,
    /// The time between pieces that a single thread needs.
    Dispatch,
    /// The additional time between pieces with several threads: locks, a shared counter.
    Contention,
    /// Threads have finished while others compute.
    Imbalance,
    /// Time before threads begin and after they have ended.
    Serial,
}

impl Cause {
    /// All causes, in the order of the tables.
    pub const ALL: [Self; 6] = [
        Self::Redundant,
        Self::Slowdown,
        Self::Dispatch,
        Self::Contention,
        Self::Imbalance,
        Self::Serial,
    ];
}

/// The thread-time lost to each cause, in nanoseconds; negative where time is gained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostTime([f64; Cause::ALL.len()]);

/// A thread's computing time, without the cost of recording.
struct Span {
    begin: f64,
    end: f64,
    busy: f64,
}

impl TimeBreakdown {
    /// Breaks down a rendering on `threads` threads, or on as many as computed if these are more,
    /// without the `cost` of recording.
    ///
    /// Each piece of a thread is moved earlier by the cost of those that the thread recorded
    /// before. The rendering then ends as much earlier as the last piece of all.
    #[must_use]
    pub fn of(timeline: &Timeline, threads: usize, cost: RecordingCost) -> Self {
        let spans: Vec<Span> =
            timeline.lanes.iter().filter_map(|lane| Span::of(lane, cost)).collect();
        let threads = threads.max(spans.len()).max(1);
        let recorded_wall = timeline.wall_ns as f64;
        let recorded_last =
            timeline.lanes.iter().filter_map(|lane| lane.pieces.last()).map(|p| p.end_ns).max();
        let Some(recorded_last) = recorded_last.map(|ns| ns as f64) else {
            // No thread computed.
            return Self {
                threads,
                wall_ns: recorded_wall,
                busy_ns: 0.0,
                dispatch_ns: 0.0,
                waiting_ns: 0.0,
                serial_ns: threads as f64 * recorded_wall,
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

    /// Returns the number of threads times the time, in nanoseconds: the sum of all activities.
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
        // The recording of the last piece after its end delays no other piece.
        let end = last.end_ns as f64 - inside - (pieces - 1.0) * cost.outside_ns;
        Some(Self { begin, end, busy: lane.busy_ns() as f64 - inside })
    }
}

impl LostTime {
    /// Returns the time that a strategy loses on all its threads, `together`, given its breakdown
    /// on one thread, `alone`, and that of the `sequential` rendering.
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

    /// Returns the time lost to `cause`, in nanoseconds.
    #[must_use]
    pub fn to(&self, cause: Cause) -> f64 {
        self.0[cause as usize]
    }

    /// Returns the time lost to all causes together, in nanoseconds.
    #[must_use]
    pub fn total_ns(&self) -> f64 {
        self.0.iter().sum()
    }

    /// Returns the cause with the largest loss.
    #[must_use]
    pub fn largest(&self) -> Cause {
        let larger = |a: &Cause, b: &Cause| self.to(*a).total_cmp(&self.to(*b));
        // There is at least one cause, so the default is never used.
        Cause::ALL.into_iter().max_by(larger).unwrap_or(Cause::Serial)
    }
}

/// Serializes as an object with a key for each cause, in nanoseconds.
impl Serialize for LostTime {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Cause::ALL.map(|cause| (cause, self.to(cause))))
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

    /// Returns a rendering on two threads: one computes from 10 to 90 with a gap of 5, the other
    /// from 20 to 60 with gaps of 1 and 3.
    fn uneven() -> Timeline {
        timeline(100, &[&[(10, 50), (55, 90)], &[(20, 30), (31, 40), (43, 60)]])
    }

    #[test]
    fn every_nanosecond_is_counted_once() {
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

    /// Catches idle threads that are not counted, or that wait before the first piece of all.
    #[test]
    fn a_thread_without_a_piece_waits_from_the_first_to_the_last() {
        let breakdown = TimeBreakdown::of(&uneven(), 4, FREE);
        assert_eq!(
            (breakdown.waiting_ns, breakdown.serial_ns),
            (30.0 + 2.0 * 80.0, 50.0 + 2.0 * (10.0 + 10.0))
        );
        assert_eq!((breakdown.busy_ns, breakdown.dispatch_ns), (111.0, 9.0));
        // Threads beyond the expected number are counted too.
        assert_eq!(TimeBreakdown::of(&uneven(), 1, FREE), TimeBreakdown::of(&uneven(), 2, FREE));
    }

    #[test]
    fn a_rendering_without_a_piece_is_serial() {
        let breakdown = TimeBreakdown::of(&timeline(7, &[]), 3, FREE);
        assert_eq!((breakdown.thread_time_ns(), breakdown.serial_ns), (21.0, 21.0));
    }

    /// Catches a cost that is subtracted twice, for the last piece, or not from the whole.
    #[test]
    fn the_cost_of_recording_is_subtracted() {
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
    fn lost_time_adds_up_to_the_loss() {
        let sequential = TimeBreakdown::of(&timeline(90, &[&[(2, 40), (41, 88)]]), 1, FREE);
        let alone = TimeBreakdown::of(&timeline(120, &[&[(5, 40), (42, 80), (84, 110)]]), 1, FREE);
        let together = TimeBreakdown::of(&uneven(), 2, FREE);
        let lost = LostTime::new(&sequential, &alone, &together);
        let expected = [
            (Cause::Redundant, 99.0 - 85.0),
            (Cause::Slowdown, 111.0 - 99.0),
            (Cause::Dispatch, 6.0 - 1.0),
            (Cause::Contention, 9.0 - 6.0),
            (Cause::Imbalance, 30.0),
            (Cause::Serial, 50.0 - 4.0),
        ];
        assert_eq!(Cause::ALL.map(|cause| (cause, lost.to(cause))), expected);
        assert_eq!(lost.total_ns(), 2.0 * 100.0 - 90.0);
        assert_eq!(lost.largest(), Cause::Serial);
    }

    #[test]
    fn sequential_loses_only_idle_threads_against_itself() {
        let timeline = timeline(90, &[&[(2, 40), (41, 88)]]);
        let one = TimeBreakdown::of(&timeline, 1, FREE);
        assert_eq!(LostTime::new(&one, &one, &one).total_ns(), 0.0);
        let three = LostTime::new(&one, &one, &TimeBreakdown::of(&timeline, 3, FREE));
        assert_eq!((three.to(Cause::Imbalance), three.to(Cause::Serial)), (2.0 * 86.0, 2.0 * 4.0));
        assert_eq!(three.total_ns(), 2.0 * 90.0);
    }
}
