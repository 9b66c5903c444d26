//! A prepared loop, where OpenMP is available.

use crate::{Schedule, ffi};
use parking_lot::Mutex;
use rayweave_contract::{Image, Plan, Renderer, StrategyError, Tile, Work};
use rayweave_thread_team::{self as thread_team, Team};
use std::ffi::c_int;
use std::io;
use std::num::NonZeroU32;

/// Threads of OpenMP that wait for a loop; they end with it.
pub struct TileLoop {
    strategy: &'static str,
    schedule: Schedule,
    threads: c_int,
    tile: NonZeroU32,
}

impl TileLoop {
    pub fn start(
        strategy: &'static str,
        schedule: Schedule,
        plan: Plan,
    ) -> Result<Self, StrategyError> {
        // gcc's OpenMP ends the process where a thread cannot be started.
        thread_team::probe(strategy, plan.threads)?;
        let threads = plan.threads.get();
        // Too many for C are too many for any machine.
        let team_loop = Self {
            strategy,
            schedule,
            threads: c_int::try_from(threads).unwrap_or(c_int::MAX),
            tile: plan.tile,
        };
        let team = ffi::start(team_loop.threads);
        if team == team_loop.threads {
            return Ok(team_loop);
        }
        let source = io::Error::other(format!("OpenMP gave {team} (OMP_THREAD_LIMIT may be set)"));
        Err(StrategyError::Spawn { strategy, threads, source })
    }
}

impl Renderer for TileLoop {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let tiles: Vec<Mutex<Tile<'_>>> =
            image.tiles(self.tile).into_iter().map(Mutex::new).collect();
        let team = Team::new(self.strategy);
        ffi::for_each(self.schedule, self.threads, tiles.len(), &|index| {
            // After a failure the rest of the iterations return at once: a loop of OpenMP has no
            // way out.
            let _ = team.render_tile(work, &mut tiles[index].lock());
        });
        team.outcome()
    }
}

impl Drop for TileLoop {
    fn drop(&mut self) {
        ffi::end();
    }
}
