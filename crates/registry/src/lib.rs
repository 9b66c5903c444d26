//! The list of all strategies, the only place that names them. Help, tables, tests and benches
//! follow from it.

use rayweave_contract::Strategy;

/// All strategies in the order of the lessons, which is that of every table. The first is the
/// reference.
pub static STRATEGIES: &[Strategy] = &[
    rayweave_sequential::STRATEGY,
    rayweave_scoped_bands::STRATEGY,
    rayweave_mutex_image::STRATEGY,
    rayweave_mutex_image::WITH_STD,
    rayweave_mutex_rows::STRATEGY,
    rayweave_channel_rows::STRATEGY,
    rayweave_row_counter::STRATEGY,
    rayweave_tile_queue::STRATEGY,
    rayweave_rayon_pixels::STRATEGY,
    rayweave_rayon_rows::STRATEGY,
    rayweave_rayon_tiles::STRATEGY,
    rayweave_work_stealing::STRATEGY,
    rayweave_paralight_tiles::STRATEGY,
    rayweave_openmp::STATIC,
    rayweave_openmp::DYNAMIC,
    rayweave_openmp::GUIDED,
];

/// Returns the strategies that can be prepared on this machine; `all` means these.
#[must_use]
pub fn available() -> Vec<Strategy<'static>> {
    STRATEGIES.iter().copied().filter(|strategy| strategy.unavailable.is_none()).collect()
}

/// Returns the strategy that all others are compared with.
#[must_use]
pub fn reference() -> Strategy<'static> {
    STRATEGIES[0]
}

/// Returns the strategy with this name.
#[must_use]
pub fn find(name: &str) -> Option<Strategy<'static>> {
    STRATEGIES.iter().copied().find(|strategy| strategy.name == name)
}

/// Returns the strategy to use where nothing else decides.
#[must_use]
pub fn recommended() -> Strategy<'static> {
    rayweave_tile_queue::STRATEGY
}
