//! The result of `rayweave predict` as tables, as JSON, and as a plot.

mod data;
mod plot;
mod table;
#[cfg(test)]
mod tests;

use rayweave_measure::{Forecast, Machine, Noise};

/// Predicted and measured speed-ups, with the scene, the machine and its noise.
#[derive(Clone, Copy, Debug)]
pub struct ForecastView<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Width of the image in pixels.
    pub width: u32,
    /// Height of the image in pixels.
    pub height: u32,
    /// The side of a tile in pixels.
    pub tile: u32,
    /// The predictions and the measurements that they are checked with.
    pub forecast: &'a Forecast,
    /// The machine that ran the measurement.
    pub machine: &'a Machine,
    /// Other activity on the machine meanwhile.
    pub noise: &'a Noise,
}

/// The assumptions of every prediction.
const ASSUMPTIONS: [&str; 5] = [
    "every core is as fast as this machine's, and every thread has a core",
    "any number of threads slows each of them down as much as all threads of this machine do",
    "memory bandwidth and caches set no further limit",
    "a counter, lock or channel costs as much per use as on this machine, first come, first served",
    "threads start one by one, as far apart as the first two do here (many threads start faster)",
];

impl ForecastView<'_> {
    /// Returns tables of the predictions with the fitted laws and of the predictions that could be
    /// checked here, and the assumptions. There is no newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        table::text(self)
    }

    /// Returns a JSON object of schema 1 with a result for each strategy and number of threads, and
    /// the laws of each strategy. `noise` is that of a comparison, in docs/compare-json.md.
    #[must_use]
    pub fn json(&self) -> String {
        data::json(self)
    }

    /// Returns an SVG plot of speed-up over threads on logarithmic axes: predictions are lines,
    /// measurements are circles.
    ///
    /// # Errors
    ///
    /// The plotting library failed; the message is its own.
    pub fn svg(&self) -> Result<String, String> {
        crate::plot::svg("the plot", |text| plot::draw(self, text))
    }
}
