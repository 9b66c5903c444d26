//! Progress bars. They appear only on a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use rayweave_contract::{Tile, Work};
use std::borrow::Cow;
use std::time::Duration;

/// Returns a bar on standard error, hidden if that is not a terminal.
pub fn bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:24} {percent:>3} %  {elapsed}  {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
}

/// Lets a thread draw the bar ten times a second, if the bar is visible. Without a terminal there
/// is no such thread: it could be one more than the system allows.
pub fn draw_steadily(bar: &ProgressBar) {
    if !bar.is_hidden() {
        bar.enable_steady_tick(Duration::from_millis(100));
    }
}

/// A bar of the share that is done. Dropping it removes the bar.
pub struct Share(ProgressBar);

/// The resolution of a share's bar.
const STEPS: f64 = 1000.0;

impl Share {
    pub fn new() -> Self {
        Self(bar(STEPS as u64))
    }

    /// Shows that `fraction`, from 0 to 1, is done and that `message` is in progress.
    pub fn show(&self, fraction: f64, message: impl Into<Cow<'static, str>>) {
        self.0.set_message(message);
        self.0.set_position((fraction * STEPS) as u64);
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Work that shows its number of computed pixels on a bar.
pub struct ProgressWork<'a, W: ?Sized> {
    work: &'a W,
    bar: ProgressBar,
}

impl<'a, W: Work + ?Sized> ProgressWork<'a, W> {
    /// Wraps `work`, which computes `pixels` pixels.
    pub fn new(work: &'a W, pixels: u64) -> Self {
        let bar = bar(pixels);
        // The clock runs during a slow tile.
        draw_steadily(&bar);
        Self { work, bar }
    }

    /// Returns whether the bar is visible, because standard error is a terminal.
    pub fn is_seen(&self) -> bool {
        !self.bar.is_hidden()
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl<W: Work + ?Sized> Work for ProgressWork<'_, W> {
    fn render(&self, tile: &mut Tile<'_>) {
        self.work.render(tile);
        let rect = tile.rect();
        self.bar.inc(u64::from(rect.width) * u64::from(rect.height));
    }
}
