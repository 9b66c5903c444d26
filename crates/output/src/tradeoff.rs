//! Speed against error, as a table, for other programs, and as a plot.

mod data;
mod plot;
mod table;

use rayweave_accuracy::tradeoff::{Setting, TradeoffRow, TradeoffStudy};
use rayweave_measure::Machine;

/// A study with everything that is needed to read it.
#[derive(Clone, Copy, Debug)]
pub struct TradeoffView<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Of the pictures, in pixels.
    pub width: u32,
    /// Of the pictures, in pixels.
    pub height: u32,
    /// What was measured.
    pub study: &'a TradeoffStudy,
    /// The PSNR in dB that a setting is asked for.
    pub target_psnr: f64,
    /// What it was measured on.
    pub machine: &'a Machine,
}

impl TradeoffView<'_> {
    /// For people: every setting, which of them are worth choosing, and what to choose. Without a
    /// newline at the end.
    #[must_use]
    pub fn table(&self) -> String {
        table::text(self)
    }

    /// For programs: an object of schema 1, a result a setting.
    #[must_use]
    pub fn json(&self) -> String {
        data::json(self)
    }

    /// For spreadsheets: a line of names, then one line a setting.
    #[must_use]
    pub fn csv(&self) -> String {
        data::csv(self)
    }

    /// Time and error of every setting on logarithmic axes, a panel an arithmetic, as SVG.
    ///
    /// # Errors
    ///
    /// What the plotting library says.
    pub fn svg(&self) -> Result<String, String> {
        plot::svg(self)
    }

    /// The settings that no other one beats in both time and error, the fastest first.
    fn front(&self) -> Vec<&TradeoffRow> {
        let mut front: Vec<&TradeoffRow> =
            self.study.rows.iter().filter(|row| row.in_front).collect();
        front.sort_by(|a, b| a.median_ns.total_cmp(&b.median_ns));
        front
    }
}

/// Where a setting's samples lie; nothing to say of one ray a pixel.
fn sampling_name(setting: &Setting) -> String {
    match setting.antialiasing {
        0 => "-".to_owned(),
        _ if setting.adaptive => "adaptive".to_owned(),
        _ => setting.sampling.to_string(),
    }
}
