//! The list of all strategies, the only place that names them. Help, tables, tests and benches
//! follow from it.

use rayweave_contract::Strategy;

/// All strategies, in the order of every table: the reference first, then from the simplest on.
pub static STRATEGIES: &[&dyn Strategy] = &[
    &rayweave_sequential::Sequential,
    &rayweave_scoped_bands::ScopedBands,
    &rayweave_row_counter::RowCounter,
    &rayweave_rayon_pixels::RayonPixels,
    &rayweave_rayon_rows::RayonRows,
    &rayweave_rayon_tiles::RayonTiles,
    &rayweave_mutex_image::MutexImage,
    &rayweave_std_mutex_image::StdMutexImage,
    &rayweave_mutex_rows::MutexRows,
    &rayweave_channel_rows::ChannelRows,
    &rayweave_tile_queue::TileQueue,
    &rayweave_work_stealing::WorkStealing,
    &rayweave_paralight_tiles::ParalightTiles,
    &rayweave_openmp::STATIC,
    &rayweave_openmp::DYNAMIC,
    &rayweave_openmp::GUIDED,
];

/// Returns the strategies that can be prepared on this machine; `all` means these.
#[must_use]
pub fn available() -> Vec<&'static dyn Strategy> {
    STRATEGIES.iter().copied().filter(|strategy| strategy.unavailable().is_none()).collect()
}

/// Returns the strategy that all others are compared with.
#[must_use]
pub fn reference() -> &'static dyn Strategy {
    STRATEGIES[0]
}

/// Returns the strategy with this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static dyn Strategy> {
    STRATEGIES.iter().copied().find(|strategy| strategy.name() == name)
}

/// Returns the strategy to use where nothing else decides.
#[must_use]
pub fn recommended() -> &'static dyn Strategy {
    &rayweave_tile_queue::TileQueue
}
