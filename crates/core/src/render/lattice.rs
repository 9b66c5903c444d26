//! The filter over a lattice that neighbouring pixels share.
//!
//! Each point's colour goes into every pixel that needs it, in the order in which a pixel alone
//! would sum it.

use crate::render::samples::Colors;
use crate::simd::lane::Scalar;
use rayweave_contract::{Rgb, Tile};

/// The rows of a lattice, summed into the pixels of a tile.
///
/// The filter is separable. The colours of a lattice row are first summed for each column of
/// pixels. These sums then serve every row of pixels that the lattice row touches, at most three.
#[derive(Debug)]
pub(crate) struct LatticeSums<'a, S> {
    /// The weights of the `2 s + 1` samples across a pixel.
    weights: &'a [S],
    density: usize,
    /// The width of the tile, in pixels.
    width: usize,
    /// The colours of a strip of lattice rows, one list a channel. Within a row, points that are
    /// `s` steps apart lie next to each other, because the sums read them in this order.
    strip: [Vec<S>; 3],
    /// The index in the strip of each expected colour, in the order in which they come.
    slots: Vec<u32>,
    /// The sums of one lattice row, for each column of pixels.
    row: [Vec<S>; 3],
    /// The sums of the rows of pixels that are not complete yet. Row `y` is at index `y % 3`.
    pixels: [[Vec<S>; 3]; 3],
}

impl<'a, S: Scalar> LatticeSums<'a, S> {
    /// Makes the sums of a tile of `width` pixels, with `density` lattice steps a pixel.
    pub(crate) fn new(weights: &'a [S], density: usize, width: usize) -> Self {
        let channels = |count: usize| [(); 3].map(|()| vec![S::literal(0.0); count]);
        Self {
            weights,
            density,
            width,
            strip: channels(0),
            slots: Vec::new(),
            row: channels(width),
            pixels: [(); 3].map(|()| channels(width)),
        }
    }

    /// Returns the index in the strip of a lattice point.
    #[inline(always)]
    fn slot(&self, column: usize, row: usize) -> usize {
        (row * self.density + column % self.density) * (self.width + 2) + column / self.density
    }

    /// Begins strips of `rows` rows, whose points are [expected](Self::expect) next. The colours of
    /// the last strip stay until they are overwritten.
    pub(crate) fn start_strip(&mut self, rows: usize) {
        self.slots.clear();
        let size = rows * self.density * (self.width + 2);
        self.strip.iter_mut().for_each(|channel| channel.resize(size, S::literal(0.0)));
    }

    /// Adds the point at a column and row of the strip to the expected points.
    pub(crate) fn expect(&mut self, column: usize, row: usize) {
        self.slots.push(self.slot(column, row) as u32);
    }

    /// Stores the colours of the expected points, in their order. Further colours come from unused
    /// lanes, and are ignored.
    pub(crate) fn fill(&mut self, colors: &Colors<S>) {
        debug_assert!(colors.channels[0].len() >= self.slots.len(), "a point without a colour");
        let [red, green, blue] = &mut self.strip;
        // Slices of one length need one bounds check for a slot.
        let (green, blue) = (&mut green[..red.len()], &mut blue[..red.len()]);
        let [reds, greens, blues] = &colors.channels;
        for (((&slot, &r), &g), &b) in self.slots.iter().zip(reds).zip(greens).zip(blues) {
            let slot = slot as usize;
            (red[slot], green[slot], blue[slot]) = (r, g, b);
        }
    }

    /// Returns one channel of the points `dx` steps to the right of each pixel centre, in a row of
    /// the strip.
    ///
    /// The centres reach from the one left of the tile to the one right of it, where the lattice
    /// ends: there only `dx` = 0 is a point. `dx` has to be below the density.
    #[inline(always)]
    pub(crate) fn points_mut(&mut self, channel: usize, dx: usize, row: usize) -> &mut [S] {
        let first = self.slot(dx, row);
        &mut self.strip[channel][first..first + self.width + 2]
    }

    /// Adds row `row` of the strip, which is row `lattice_row` of the tile's lattice, to the rows
    /// of pixels that it touches, and writes the row of pixels that it completes.
    pub(crate) fn add_row(&mut self, row: usize, lattice_row: usize, tile: &mut Tile<'_>) {
        for channel in 0..3 {
            self.row[channel].fill(S::literal(0.0));
            for (k, &weight) in self.weights.iter().enumerate() {
                let first = self.slot(k, row);
                let colors = &self.strip[channel][first..first + self.width];
                add_weighted(&mut self.row[channel], colors, weight);
            }
        }
        let last = self.weights.len() - 1;
        let height = tile.rect().height as usize;
        let touched = lattice_row.saturating_sub(last).div_ceil(self.density)
            ..height.min(lattice_row / self.density + 1);
        for y in touched {
            let step = lattice_row - y * self.density;
            let pixels = &mut self.pixels[y % 3];
            for (sum, row) in pixels.iter_mut().zip(&self.row) {
                if step == 0 {
                    sum.fill(S::literal(0.0));
                }
                add_weighted(sum, row, self.weights[step]);
            }
            if step == last {
                write(pixels, tile.row_mut(y));
            }
        }
    }
}

#[inline(always)]
fn add_weighted<S: Scalar>(sums: &mut [S], colors: &[S], weight: S) {
    for (sum, &color) in sums.iter_mut().zip(colors) {
        *sum = *sum + color * weight;
    }
}

fn write<S: Scalar>([red, green, blue]: &[Vec<S>; 3], pixels: &mut [Rgb]) {
    for (((pixel, red), green), blue) in pixels.iter_mut().zip(red).zip(green).zip(blue) {
        *pixel = [red.to_f32(), green.to_f32(), blue.to_f32()];
    }
}
