//! The result of `rayweave tradeoff` as a table, as JSON and CSV, and as a plot.

mod data;
mod plot;
mod table;

use rayweave_accuracy::tradeoff::{Setting, TradeoffRow, TradeoffStudy};
use rayweave_measure::Machine;

/// Speed and error of every setting, with the scene, the target and the machine.
#[derive(Clone, Copy, Debug)]
pub struct TradeoffView<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Width of the images in pixels.
    pub width: u32,
    /// Height of the images in pixels.
    pub height: u32,
    /// The measured settings.
    pub study: &'a TradeoffStudy,
    /// The PSNR in dB that the recommended setting has to reach.
    pub target_psnr: f64,
    /// The machine that ran the measurement.
    pub machine: &'a Machine,
}

impl TradeoffView<'_> {
    /// Returns tables of every setting, of the Pareto front and of the costs of each arithmetic,
    /// and a recommendation. There is no newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        table::text(self)
    }

    /// Returns a JSON object of schema 1 with a result for each setting.
    #[must_use]
    pub fn json(&self) -> String {
        data::json(self)
    }

    /// Returns CSV: a line of names, then one line for each setting.
    #[must_use]
    pub fn csv(&self) -> String {
        data::csv(self)
    }

    /// Returns an SVG plot of time and error of every setting on logarithmic axes, with a panel for
    /// each arithmetic.
    ///
    /// # Errors
    ///
    /// The plotting library failed; the message is its own.
    pub fn svg(&self) -> Result<String, String> {
        crate::plot::svg("the plot", |text| plot::draw(self, text))
    }

    /// Returns the settings that no other one beats in both time and error, the fastest first.
    fn front(&self) -> Vec<&TradeoffRow> {
        let mut front: Vec<&TradeoffRow> =
            self.study.rows.iter().filter(|row| row.in_front).collect();
        front.sort_by(|a, b| a.median_ns.total_cmp(&b.median_ns));
        front
    }
}

/// Returns the name of the sample positions, or "-" for one ray a pixel.
fn sampling_name(setting: &Setting) -> String {
    match setting.antialiasing {
        0 => "-".to_owned(),
        _ if setting.adaptive => "adaptive".to_owned(),
        _ => setting.sampling.to_string(),
    }
}
