//! Forks N scoped threads, joins them, and lets them stop together: what every strategy with
//! hand-spawned threads needs, and no strategy should have to say twice.
//!
//! The team is forked at each call of [`run`]; nothing outlives it. The caller's thread only waits.

use rayweave_core::strategy::render_tile;
use rayweave_core::{StrategyError, Tile, Work};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// The team's word that a member failed: leave the work as it is and return.
#[derive(Debug)]
pub struct Stop;

/// One thread of the team.
#[derive(Debug)]
pub struct Member<'team> {
    team: &'team Team,
}

#[derive(Debug)]
struct Team {
    strategy: &'static str,
    stopped: AtomicBool,
    first_error: Mutex<Option<StrategyError>>,
}

/// Runs `body` on one thread for each of `shares`, all at the same time, and waits for them.
///
/// A share is what the thread alone works on: a range, slices of the picture, or nothing but a
/// reference to a queue that all of them take from.
///
/// # Errors
///
/// The first failure of any member: work that panicked, or a thread that could not be started.
/// The members that run are told to stop at their next tile, and are joined before this returns.
pub fn run<Share: Send>(
    strategy: &'static str,
    shares: impl ExactSizeIterator<Item = Share>,
    body: impl Fn(&Member<'_>, Share) -> Result<(), Stop> + Sync,
) -> Result<(), StrategyError> {
    let threads = shares.len();
    let team = Team { strategy, stopped: AtomicBool::new(false), first_error: Mutex::new(None) };
    let (team_ref, body) = (&team, &body);
    thread::scope(|scope| {
        for (index, share) in shares.enumerate() {
            let thread = thread::Builder::new().name(format!("{strategy} {index}"));
            let member = Member { team: team_ref };
            // A member that returns `Stop` has nothing to add: the failure is with the team.
            if let Err(source) = thread.spawn_scoped(scope, move || drop(body(&member, share))) {
                team_ref.fail(StrategyError::Spawn { strategy, threads, source });
                break;
            }
        }
    });
    let first_error = team.first_error.into_inner().unwrap_or_else(PoisonError::into_inner);
    first_error.map_or(Ok(()), Err)
}

impl Member<'_> {
    /// Renders one tile, unless the team has stopped.
    ///
    /// # Errors
    ///
    /// [`Stop`] when this work or another member's failed.
    pub fn render_tile(&self, work: &dyn Work, tile: &mut Tile<'_>) -> Result<(), Stop> {
        if self.team.stopped.load(Ordering::Relaxed) {
            return Err(Stop);
        }
        render_tile(self.team.strategy, work, tile).map_err(|error| self.team.fail(error))
    }
}

impl Team {
    fn fail(&self, error: StrategyError) -> Stop {
        let mut first = self.first_error.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
        self.stopped.store(true, Ordering::Relaxed);
        Stop
    }
}
