//! A prepared loop, where OpenMP is available.

use crate::{Schedule, ffi};
use parking_lot::Mutex;
use rayweave_contract::{Image, Plan, RenderError, Work};
use rayweave_thread_team::{self as thread_team, Team};
use std::ffi::c_int;
use std::io;
use std::num::NonZeroU32;

/// Threads of OpenMP that wait for a loop; they end with it.
pub struct TeamLoop {
    schedule: Schedule,
    threads: c_int,
    tile: NonZeroU32,
}

impl TeamLoop {
    pub fn start(schedule: Schedule, plan: Plan) -> Result<Self, RenderError> {
        // gcc's OpenMP ends the process where a thread cannot be started.
        thread_team::probe(plan.threads)?;
        // Too many for C are too many for any machine.
        let threads = c_int::try_from(plan.threads.get()).unwrap_or(c_int::MAX);
        let team_loop = Self { schedule, threads, tile: plan.tile };
        let team = ffi::start(threads);
        if team == threads {
            return Ok(team_loop);
        }
        let source = io::Error::other(format!("OpenMP gave {team} (OMP_THREAD_LIMIT may be set)"));
        Err(RenderError::Spawn { threads: plan.threads.get(), source })
    }

    pub fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
        let tiles: Vec<_> = image.tiles(self.tile).into_iter().map(Mutex::new).collect();
        let team = Team::default();
        ffi::for_each(self.schedule, self.threads, tiles.len(), &|index| {
            // After a failure the rest of the iterations return at once: a loop of OpenMP has no
            // way out.
            let _ = team.render_tile(work, &mut tiles[index].lock());
        });
        team.outcome()
    }
}

impl Drop for TeamLoop {
    fn drop(&mut self) {
        ffi::end();
    }
}
