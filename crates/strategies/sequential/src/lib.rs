//! `sequential`: the caller's thread computes tile after tile.
//!
//! * **What it decides**: nothing. It is the loop that every other strategy has to beat, and the
//!   image that every other strategy has to reproduce.
//! * **What it costs**: no thread, no lock, no queue. The other cores idle.
//! * **When it is right**: for an image that takes less time than starting a thread (tens of
//!   microseconds), or when the cores are busy with other images already.

use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
    Threads, Work, render_tile,
};
use std::num::NonZeroU32;

const NAME: &str = "sequential";

/// The caller's thread, tile after tile.
#[derive(Debug)]
pub struct Sequential;

impl Strategy for Sequential {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "one thread, tile after tile: the reference"
    }

    fn threads(&self) -> Threads {
        Threads::None
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::Static,
            output: Output::InPlace,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(TileByTile { tile: plan.tile }))
    }
}

struct TileByTile {
    tile: NonZeroU32,
}

impl Renderer for TileByTile {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        image.tiles(self.tile).iter_mut().try_for_each(|tile| render_tile(NAME, work, tile))
    }
}
