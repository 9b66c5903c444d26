//! Images in which each pixel shows the thread that computed it, or its time.

use super::color;
use crate::plot::Drawn;
use plotters::prelude::*;
use rayweave_contract::{Image, Rect};
use rayweave_measure::explanation::ExplainedStrategy;
use rayweave_measure::timeline::{Piece, Timeline};

/// The longer side of the drawing in pixels, without the frame.
const SIDE: u32 = 800;

/// Width and height of title, axes and scale in pixels.
const FRAME: (u32, u32) = (190, 110);

/// The largest number of rectangles that a viewer draws quickly.
const MAX_CELLS: u64 = 20_000;

/// The number of colours in the scale.
const STEPS: u32 = 64;

/// Five colours of "viridis" by Smith and van der Walt, 2015, for the shortest to the longest time.
const VIRIDIS: [[f64; 3]; 5] = [
    [68.0, 1.0, 84.0],
    [59.0, 82.0, 139.0],
    [33.0, 145.0, 140.0],
    [94.0, 201.0, 98.0],
    [253.0, 231.0, 37.0],
];

/// Paints each pixel of `image` in the colour of the thread that computed it. Other pixels keep
/// their colour.
pub(super) fn owners(timeline: &Timeline, mut image: Image) -> Image {
    let (width, height) = (image.width(), image.height());
    for (index, lane) in timeline.lanes.iter().enumerate() {
        let RGBColor(red, green, blue) = color(index);
        let rgb = [red, green, blue].map(|channel| f32::from(channel) / 255.0);
        for Piece { rect, .. } in &lane.pieces {
            let columns = rect.x.min(width) as usize..(rect.x + rect.width).min(width) as usize;
            for y in rect.y.min(height)..(rect.y + rect.height).min(height) {
                image.pixels_mut()[y as usize * width as usize..][columns.clone()].fill(rgb);
            }
        }
    }
    image
}

/// A part of the image, and the mean time of its pixels in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    rect: Rect,
    ns: f64,
}

/// Returns the pieces themselves, or squares of pixels if there are too many pieces.
fn cells(timeline: &Timeline, (width, height): (u32, u32)) -> Vec<Cell> {
    let pieces = || timeline.lanes.iter().flat_map(|lane| &lane.pieces);
    let pixels = |rect: Rect| f64::from(rect.width) * f64::from(rect.height);
    if timeline.pieces() as u64 <= MAX_CELLS {
        let cell =
            |piece: &Piece| Cell { rect: piece.rect, ns: piece.ns() as f64 / pixels(piece.rect) };
        return pieces().map(cell).collect();
    }
    let cut = |side: u32| u64::from(width.div_ceil(side)) * u64::from(height.div_ceil(side));
    let side = (1..).find(|&side| cut(side) <= MAX_CELLS).unwrap_or(u32::MAX);
    let columns = width.div_ceil(side) as usize;
    let mut sums = vec![0.0; columns * height.div_ceil(side) as usize];
    for piece in pieces() {
        let Rect { x, y, width, height } = piece.rect;
        let ns = piece.ns() as f64 / pixels(piece.rect);
        for y in y..y + height {
            for x in x..x + width {
                if let Some(sum) = sums.get_mut((y / side) as usize * columns + (x / side) as usize)
                {
                    *sum += ns;
                }
            }
        }
    }
    let cell = |(place, &sum): (usize, &f64)| {
        let (x, y) = ((place % columns) as u32 * side, (place / columns) as u32 * side);
        let rect = Rect { x, y, width: side.min(width - x), height: side.min(height - y) };
        Cell { rect, ns: sum / pixels(rect) }
    };
    sums.iter().enumerate().map(cell).collect()
}

/// Draws the time of each part of the image, and the scale.
pub(super) fn draw(
    row: &ExplainedStrategy,
    (width, height): (u32, u32),
    text: &mut String,
) -> Drawn {
    let cells = cells(&row.timeline, (width, height));
    // A coarse clock may measure 0 ns, which has no logarithm.
    let logarithm = |ns: f64| ns.max(1.0).log10();
    let least = cells.iter().map(|cell| logarithm(cell.ns)).fold(f64::INFINITY, f64::min).min(9.0);
    let most = cells.iter().map(|cell| logarithm(cell.ns)).fold(least, f64::max).max(least + 0.01);
    let shade = |value: f64| viridis((value - least) / (most - least));

    let scale = f64::from(SIDE) / f64::from(width.max(height));
    let side = |pixels: u32| (f64::from(pixels) * scale).round().max(60.0) as u32;
    let root = SVGBackend::with_string(text, (side(width) + FRAME.0, side(height) + FRAME.1));
    let root = root.into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(&format!("{}: time of each pixel", row.strategy), ("sans-serif", 20))?;
    let (left, right) = root.split_horizontally(side(width) + FRAME.0 - 110);
    // The image's rows count from the top, the chart's axis from the bottom.
    let mut chart = ChartBuilder::on(&left)
        .margin(10)
        .x_label_area_size(30)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..f64::from(width), 0.0..f64::from(height))?;
    chart
        .configure_mesh()
        .disable_mesh()
        .y_label_formatter(&|y| format!("{:.0}", f64::from(height) - y))
        .x_label_formatter(&|x| format!("{x:.0}"))
        .draw()?;
    chart.draw_series(cells.iter().map(|&Cell { rect, ns }| {
        let corner = |x: u32, y: u32| (f64::from(x), f64::from(height) - f64::from(y));
        let corners = [corner(rect.x, rect.y), corner(rect.x + rect.width, rect.y + rect.height)];
        Rectangle::new(corners, shade(logarithm(ns)).filled())
    }))?;
    let mut scale = ChartBuilder::on(&right)
        .margin(10)
        .x_label_area_size(30)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..1.0, least..most)?;
    scale
        .configure_mesh()
        .disable_mesh()
        .x_labels(0)
        .y_desc("us a pixel")
        .axis_desc_style(("sans-serif", 12))
        // The default size follows the width of this narrow panel.
        .label_style(("sans-serif", 12))
        .y_label_formatter(&|value| microseconds(*value))
        .draw()?;
    let step = (most - least) / f64::from(STEPS);
    scale.draw_series((0..STEPS).map(|place| {
        let bottom = least + f64::from(place) * step;
        Rectangle::new([(0.0, bottom), (1.0, bottom + step)], shade(bottom + step / 2.0).filled())
    }))?;
    root.present()?;
    Ok(())
}

/// Returns microseconds with three digits, from the logarithm to base 10 of nanoseconds.
fn microseconds(logarithm: f64) -> String {
    // The number of digits before the point.
    let before = (logarithm - 3.0).floor().max(-1.0) as i32 + 1;
    let after = usize::try_from(3 - before).unwrap_or(0);
    format!("{:.after$}", 10f64.powf(logarithm - 3.0))
}

/// Returns the colour of a share from 0 to 1, interpolated linearly.
fn viridis(share: f64) -> RGBColor {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - below as f64;
    let channel =
        |i: usize| (VIRIDIS[below][i] * (1.0 - part) + VIRIDIS[below + 1][i] * part).round() as u8;
    RGBColor(channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayweave_measure::timeline::TimelineLane;

    fn piece((x, y, width, height): (u32, u32, u32, u32), ns: u64) -> Piece {
        Piece { rect: Rect { x, y, width, height }, begin_ns: 100, end_ns: 100 + ns }
    }

    fn timeline(lanes: [Vec<Piece>; 2]) -> Timeline {
        Timeline {
            wall_ns: 1000,
            lanes: lanes.map(|pieces| TimelineLane { name: None, pieces }).to_vec(),
        }
    }

    /// Catches swapped rows and columns, a neighbour's colour, and a piece beyond the image.
    #[test]
    fn each_pixel_shows_its_thread() {
        let timeline = timeline([vec![piece((0, 0, 2, 1), 1)], vec![piece((2, 1, 5, 5), 1)]]);
        let image = owners(&timeline, Image::new(3, 2).expect("an image"));
        let [first, second] =
            [0, 1].map(|thread| [color(thread).0, color(thread).1, color(thread).2]);
        let expected = [first, first, [0; 3], [0; 3], [0; 3], second];
        assert_eq!(image.to_rgb8(), expected.concat());
    }

    #[test]
    fn few_pieces_are_cells_and_many_are_summed_up() {
        let few = timeline([vec![piece((0, 0, 2, 3), 12)], vec![piece((2, 0, 1, 1), 5)]]);
        let cell = |x, y, width, height, ns| Cell { rect: Rect { x, y, width, height }, ns };
        assert_eq!(cells(&few, (3, 3)), [cell(0, 0, 2, 3, 2.0), cell(2, 0, 1, 1, 5.0)]);

        // 201 x 101 pixels make squares of two, the last column and row cut off. A pixel's time
        // is its x.
        let pixels: Vec<Piece> = (0..101)
            .flat_map(|y| (0..201).map(move |x| piece((x, y, 1, 1), u64::from(x))))
            .collect();
        let cells = cells(&timeline([pixels, Vec::new()]), (201, 101));
        assert_eq!(cells.len(), 101 * 51);
        assert_eq!(cells[..2], [cell(0, 0, 2, 2, 0.5), cell(2, 0, 2, 2, 2.5)]);
        assert_eq!(cells[101 * 51 - 1], cell(200, 100, 1, 1, 200.0));
    }

    #[test]
    fn the_scale_has_three_digits() {
        let texts = [0.0, 2.5, 3.0, 4.2, 5.0, 7.0].map(microseconds);
        assert_eq!(texts, ["0.001", "0.316", "1.00", "15.8", "100", "10000"]);
    }

    #[test]
    fn the_scale_meets_its_colours() {
        let colors = [-1.0, 0.0, 0.5, 0.625, 1.0, 2.0].map(viridis);
        let expected = [
            (68, 1, 84),
            (68, 1, 84),
            (33, 145, 140),
            (64, 173, 119),
            (253, 231, 37),
            (253, 231, 37),
        ];
        assert_eq!(colors, expected.map(|(red, green, blue)| RGBColor(red, green, blue)));
    }
}
