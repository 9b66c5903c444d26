//! What more threads would do: as tables, a plot, and for other programs.

mod data;
mod plot;
mod table;
#[cfg(test)]
mod tests;

use rayweave_measure::{Forecast, Machine, Noise};

use ForecastView as Report;

/// A forecast with everything that is needed to read it.
#[derive(Clone, Copy, Debug)]
pub struct ForecastView<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Of the picture, in pixels.
    pub width: u32,
    /// Of the picture, in pixels.
    pub height: u32,
    /// The side of a tile, in pixels.
    pub tile: u32,
    /// What was predicted, and measured.
    pub forecast: &'a Forecast,
    /// What it was measured on.
    pub machine: &'a Machine,
    /// What else went on there.
    pub noise: &'a Noise,
}

/// What a prediction takes for granted.
const ASSUMPTIONS: [&str; 5] = [
    "every core is as good as one of this machine, and no thread waits for a core",
    "beside others a thread is slowed down as by all threads of this machine, however many they are",
    "memory bandwidth and caches are no limit but for that",
    "a counter, a lock or a channel costs on many threads what it costs on this machine's, in the order of asking",
    "threads start one after the other, each as long after the one before as the second after the first here: its waking up \
     is in that, so many threads start faster",
];

impl ForecastView<'_> {
    /// For people: predictions with the fitted laws, what of them could be checked here, and what
    /// they assume. Without a newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        table::text(self)
    }

    /// For programs: an object of schema 1, a result a strategy and number of threads, a law a
    /// strategy. `noise` is that of a comparison, in docs/compare-json.md.
    #[must_use]
    pub fn json(&self) -> String {
        data::json(self)
    }

    /// Speed-ups over numbers of threads on logarithmic axes, as SVG: lines predicted, circles
    /// measured.
    ///
    /// # Errors
    ///
    /// What the plotting library says.
    pub fn svg(&self) -> Result<String, String> {
        plot::svg(self)
    }
}
