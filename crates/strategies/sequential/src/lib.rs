//! Lesson 1, `sequential`: the caller's thread computes tile after tile.
//!
//! In the lab report: `for (x ...) for (y ...) image[y][x] = color(x, y);`, column after column.
//!
//! * **New**: the work is a function that fills a tile of the image. A strategy is the loop around
//!   it: it says which thread computes which tile, and when.
//! * **What it decides**: nothing. Every other strategy has to be faster, and has to compute the
//!   same image, bit for bit.
//! * **What it costs**: nothing but the time of one core. The other cores idle.
//! * **When it is right**: for an image that takes less time than starting a thread (tens of
//!   microseconds), or when the cores are busy with other images already.

use rayweave_contract::*;

/// One thread, one tile after the other.
pub static STRATEGY: Strategy = Strategy {
    name: "sequential",
    summary: "one thread, tile after tile: the reference",
    threads: Threads::None,
    policy: Policy::new(Granularity::Tile, Scheduling::Static, Output::InPlace),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    image.tiles(plan.tile).iter_mut().try_for_each(|tile| render_tile(work, tile))
}
