//! The parts that every SVG drawing of this crate shares.

use plotters::prelude::DrawingAreaErrorKind;

/// The result of drawing into a string.
pub(crate) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Returns the SVG that `draw` writes, or an error that names the drawing as `name`.
pub(crate) fn svg(name: &str, draw: impl FnOnce(&mut String) -> Drawn) -> Result<String, String> {
    let mut text = String::new();
    draw(&mut text).map_err(|e| format!("{name} cannot be drawn: {e}"))?;
    Ok(text)
}
