//! What is measured when: interleaved rounds, in each of which every entry has one turn, in an
//! order shuffled by a seeded generator. What drifts (heat, clock rate, neighbours) meets all of
//! them, and none is always after the same other.

use crate::random::SplitMix64;
use std::time::Duration;

/// How long and in what order to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protocol {
    /// Rounds to measure whatever they take, 1 or more.
    pub min_rounds: usize,
    /// Rounds to end after.
    pub max_rounds: usize,
    /// No round is begun, after the least number of them, that would go beyond this. What comes
    /// before the first turn and the warm-up count too.
    pub budget: Duration,
    /// The half of an interval, as a share of the median speed-up, that is narrow enough: once
    /// every row is as precise no round is begun after the least number.
    pub goal: Option<f64>,
    /// Of the order within the rounds.
    pub seed: u64,
}

impl Default for Protocol {
    /// 8 to 40 rounds in two and a half minutes: of fewer than 6 there is no 95 % interval, and a
    /// narrow one by chance ends no measurement.
    fn default() -> Self {
        Self {
            min_rounds: 8,
            max_rounds: 40,
            budget: Duration::from_secs(150),
            goal: None,
            seed: 1,
        }
    }
}

impl Protocol {
    /// The same, or with as many rounds as fit into `limit` if there is one.
    #[must_use]
    pub fn within(self, limit: Option<Duration>) -> Self {
        limit.map_or(self, |budget| Self { max_rounds: usize::MAX, budget, ..self })
    }

    /// The turns of `entries` entries: one warm-up round in the order of the entries, then the
    /// rounds.
    #[must_use]
    pub fn schedule(&self, entries: usize) -> Schedule {
        Schedule {
            protocol: *self,
            random: SplitMix64::new(self.seed),
            order: (0..entries).collect(),
            place: 0,
            round: None,
            begin: None,
        }
    }

    /// Whether to begin a round after `rounds` of them, if it would end at `end`.
    fn wants_another(&self, rounds: usize, end: Duration) -> bool {
        rounds < self.min_rounds.max(1) || (rounds < self.max_rounds && end <= self.budget)
    }

    /// How much is done, by rounds or by time, whichever is nearer to the end: 0 to 1.
    fn fraction(&self, rounds: usize, elapsed: Duration) -> f64 {
        let of = |rounds: usize, all: usize| (rounds as f64 / all.max(1) as f64).min(1.0);
        let time = elapsed.as_secs_f64() / self.budget.as_secs_f64().max(f64::MIN_POSITIVE);
        of(rounds, self.min_rounds).min(time.min(1.0)).max(of(rounds, self.max_rounds))
    }
}

/// Whose turn it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The number of the entry.
    pub entry: usize,
    /// Rounds done before this one; `None` during the warm-up, which is not counted.
    pub round: Option<usize>,
    /// Whether a round begins.
    pub first: bool,
    /// How much of the whole is done: 0 to 1.
    pub fraction: f64,
}

/// The turns of a measurement, asked for one after the other.
#[derive(Debug)]
pub struct Schedule {
    protocol: Protocol,
    random: SplitMix64,
    order: Vec<usize>,
    /// In the order, of the next turn.
    place: usize,
    /// As in [`Turn::round`].
    round: Option<usize>,
    /// When the running round began; `None` before the first.
    begin: Option<Duration>,
}

impl Schedule {
    /// The next turn, `elapsed` after the measurement began, or `None` at the end of it.
    pub fn next(&mut self, elapsed: Duration) -> Option<Turn> {
        if self.order.is_empty() {
            return None;
        }
        if self.place == self.order.len() {
            // The warm-up is no round, but says how long one takes.
            let round = elapsed.saturating_sub(self.begin.unwrap_or_default());
            let done = self.rounds();
            if !self.protocol.wants_another(done, elapsed + round) {
                return None;
            }
            self.round = Some(done);
            self.random.shuffle(&mut self.order);
            self.place = 0;
        }
        let first = self.place == 0;
        if first {
            self.begin = Some(elapsed);
        }
        self.place += 1;
        let fraction = self.protocol.fraction(self.round.unwrap_or(0), elapsed);
        Some(Turn { entry: self.order[self.place - 1], round: self.round, first, fraction })
    }

    /// Rounds that are complete, the warm-up not counted.
    #[must_use]
    pub fn rounds(&self) -> usize {
        let running = self.place < self.order.len();
        self.round.map_or(0, |before| before + usize::from(!running))
    }
}
