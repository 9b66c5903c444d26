//! The order and the number of the measurements: interleaved rounds, each with one slot for every
//! entry, in an order shuffled by a seeded generator. Drift (heat, clock rate, other programs)
//! affects all entries alike, and no entry always follows the same other.

use crate::random::SplitMix64;
use std::time::Duration;

/// The number of rounds, the time for them, and the seed of their order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protocol {
    /// The number of rounds to measure even if they exceed the budget, 1 or more.
    pub min_rounds: usize,
    /// The number of rounds after which the measurement ends.
    pub max_rounds: usize,
    /// The time that a further round must not exceed once there are `min_rounds`. The time before
    /// the first slot and the warm-up count too.
    pub budget: Duration,
    /// Half of an interval's width, as a share of the median speed-up, that is narrow enough: once
    /// every row is as precise, no round is begun after `min_rounds`.
    pub goal: Option<f64>,
    /// The seed of the order within the rounds.
    pub seed: u64,
}

impl Default for Protocol {
    /// Returns 8 to 40 rounds in a minute. Fewer than 6 rounds have no 95 % interval;
    /// with 8, a narrow interval by chance does not end the measurement.
    fn default() -> Self {
        Self { min_rounds: 8, max_rounds: 40, budget: Duration::from_secs(60), goal: None, seed: 1 }
    }
}

impl Protocol {
    /// The largest number of rounds of a protocol with a time limit. More rounds would narrow an
    /// interval by nothing to speak of, and the bootstrap of half a million takes minutes.
    pub const MOST_ROUNDS: usize = 2000;

    /// Returns this protocol, or one with as many rounds as fit into `limit` if there is one, up to
    /// [`Protocol::MOST_ROUNDS`].
    #[must_use]
    pub fn within(self, limit: Option<Duration>) -> Self {
        limit.map_or(self, |budget| Self { max_rounds: Self::MOST_ROUNDS, budget, ..self })
    }

    /// Returns the slots of `entries` entries: one warm-up round in the order of the entries, then
    /// the rounds.
    #[must_use]
    pub fn rounds(&self, entries: usize) -> Rounds {
        Rounds {
            protocol: *self,
            random: SplitMix64::new(self.seed),
            order: (0..entries).collect(),
            place: 0,
            round: None,
            begin: None,
        }
    }

    /// Returns whether to begin a round after `rounds` of them, if it would end at `end`.
    fn wants_another(&self, rounds: usize, end: Duration) -> bool {
        rounds < self.min_rounds.max(1) || (rounds < self.max_rounds && end <= self.budget)
    }

    /// Returns the share that is done, by rounds or by time, whichever ends first: 0 to 1.
    fn fraction(&self, rounds: usize, elapsed: Duration) -> f64 {
        let of = |rounds: usize, all: usize| (rounds as f64 / all.max(1) as f64).min(1.0);
        let time = elapsed.as_secs_f64() / self.budget.as_secs_f64().max(f64::MIN_POSITIVE);
        of(rounds, self.min_rounds).min(time.min(1.0)).max(of(rounds, self.max_rounds))
    }
}

/// The measurement of one entry in one round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot {
    /// The number of the entry.
    pub entry: usize,
    /// The number of rounds before this one; `None` during the warm-up, which is not counted.
    pub round: Option<usize>,
    /// True if a round begins with this slot.
    pub starts_round: bool,
    /// The share of the measurement that is done: 0 to 1.
    pub fraction: f64,
}

/// The slots of a measurement, one after the other.
#[derive(Debug)]
pub struct Rounds {
    protocol: Protocol,
    random: SplitMix64,
    order: Vec<usize>,
    /// The place of the next slot in the order.
    place: usize,
    /// The same as [`Slot::round`].
    round: Option<usize>,
    /// The begin of the running round; `None` before the first.
    begin: Option<Duration>,
}

impl Rounds {
    /// Returns the next slot, `elapsed` after the measurement began, or `None` at its end.
    pub fn next(&mut self, elapsed: Duration) -> Option<Slot> {
        if self.order.is_empty() {
            return None;
        }
        if self.place == self.order.len() {
            // The warm-up does not count as a round, but its time predicts that of the next one.
            let round = elapsed.saturating_sub(self.begin.unwrap_or_default());
            let done = self.completed();
            if !self.protocol.wants_another(done, elapsed + round) {
                return None;
            }
            self.round = Some(done);
            self.random.shuffle(&mut self.order);
            self.place = 0;
        }
        let starts_round = self.place == 0;
        if starts_round {
            self.begin = Some(elapsed);
        }
        self.place += 1;
        let fraction = self.protocol.fraction(self.round.unwrap_or(0), elapsed);
        Some(Slot { entry: self.order[self.place - 1], round: self.round, starts_round, fraction })
    }

    /// Returns the number of complete rounds; the warm-up is not one.
    #[must_use]
    pub fn completed(&self) -> usize {
        let running = self.place < self.order.len();
        self.round.map_or(0, |before| before + usize::from(!running))
    }
}
