//! The reconstruction filter `exp(-(dx^2 + dy^2) / 0.64)`, as a weighted sum over samples.
//!
//! It covers the square that reaches one pixel from a pixel's centre in each direction, and is the
//! product of the same function of each coordinate.

use crate::render::samples::{Colors, SamplePositions};
use crate::scene::RenderSettings;
use crate::simd::lane::Scalar;
use crate::simd::vector::Vector;
use rayweave_contract::Rgb;

/// The samples of a pixel, row by row. They are the same around the centre of every pixel.
#[derive(Clone, Debug)]
pub(crate) struct Filter<S> {
    rows: Vec<Row<S>>,
    /// The offsets of all samples from the pixel's centre, row by row.
    positions: SamplePositions<S>,
    /// The unit of positions: half a pixel is this many half lattice steps.
    density: u32,
    /// The weights of the samples across a pixel, if the samples are on a square lattice.
    lattice: Option<Vec<S>>,
}

/// The samples of a pixel with the same y.
#[derive(Clone, Debug)]
pub(crate) struct Row<S> {
    /// The distance below the pixel's centre, in half lattice steps.
    pub(crate) dy: S,
    /// The weight of the row. The weights of all rows sum to 1, up to rounding.
    pub(crate) weight: S,
    pub(crate) samples: Vec<Sample<S>>,
}

/// A sample in a row: one ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample<S> {
    /// The distance to the right of the pixel's centre, in half lattice steps.
    pub(crate) dx: S,
    /// The weight within the row. The weights of a row sum to 1, up to rounding.
    pub(crate) weight: S,
}

impl<S: Scalar> Filter<S> {
    /// Makes the samples that `settings` ask for.
    pub(crate) fn new(settings: &RenderSettings) -> Self {
        if settings.has_lattice() {
            Self::lattice(settings.antialiasing)
        } else {
            Self::importance(settings.rays_per_pixel())
        }
    }

    fn of_rows(rows: Vec<Row<S>>, density: u32, lattice: Option<Vec<S>>) -> Self {
        let mut positions = SamplePositions::default();
        for row in &rows {
            for sample in &row.samples {
                positions.push(sample.dx, row.dy);
            }
        }
        Self { positions, rows, density, lattice }
    }

    /// Returns the number of half lattice steps from a pixel's edge to its centre.
    pub(crate) fn density(&self) -> u32 {
        self.density
    }

    /// Returns the weights of the `2 s + 1` samples across a pixel, if the samples are on a square
    /// lattice, which neighbouring pixels share.
    pub(crate) fn lattice_weights(&self) -> Option<&[S]> {
        self.lattice.as_deref()
    }

    /// Returns the offset of each sample from the pixel's centre, row by row.
    pub(crate) fn positions(&self) -> &SamplePositions<S> {
        &self.positions
    }

    /// Computes neighbouring pixels. The colours of the first pixel's samples begin at index
    /// `first`.
    pub(crate) fn sums(&self, colors: &Colors<S>, first: usize, pixels: &mut [Rgb]) {
        let samples = self.positions.len();
        if samples == 1 {
            // With one sample a pixel, the general sum would be a noticeable share of the
            // rendering.
            let here = colors.range(first..first + pixels.len());
            for (pixel, color) in pixels.iter_mut().zip(here) {
                *pixel = color.to_array().map(S::to_f32);
            }
            return;
        }
        for (i, pixel) in pixels.iter_mut().enumerate() {
            *pixel = self.sum(colors, first + i * samples);
        }
    }

    /// Returns the pixel whose samples' colours begin at index `first`.
    ///
    /// Sums each row of samples from the left, then the rows from the top. The order is fixed
    /// because it decides the bits; it allows a row's sum to serve every pixel that needs it.
    fn sum(&self, colors: &Colors<S>, first: usize) -> Rgb {
        let mut sample_colors = colors.range(first..first + self.positions.len());
        let mut color = Vector::zero();
        for row in &self.rows {
            let mut row_color = Vector::zero();
            // `zip` asks its left side first, so at a row's end it takes no colour of the next row.
            for (sample, color_there) in row.samples.iter().zip(&mut sample_colors) {
                row_color = row_color + color_there * sample.weight;
            }
            color = color + row_color * row.weight;
        }
        color.to_array().map(S::to_f32)
    }

    /// Makes `(2 s + 1)^2` samples on a square lattice with `s` steps a pixel. Positions are whole
    /// numbers of half lattice steps, so neighbouring pixels share them exactly.
    fn lattice(density: u32) -> Self {
        let reach = f64::from(density);
        let steps = || (0..=2 * density).map(|i| f64::from(i) - reach);
        // `libm` computes in software, so the bits are the same on every machine.
        let weight = |step: f64| libm::exp(-(step / reach) * (step / reach) / 0.64);
        let sum: f64 = steps().map(weight).sum();
        let samples: Vec<Sample<S>> = steps()
            .map(|step| Sample {
                dx: S::from_f64(2.0 * step),
                weight: S::from_f64(weight(step) / sum),
            })
            .collect();
        let row = |sample: &Sample<S>| Row {
            dy: sample.dx,
            weight: sample.weight,
            samples: samples.clone(),
        };
        let lattice = samples.iter().map(|sample| sample.weight).collect();
        Self::of_rows(samples.iter().map(row).collect(), density, Some(lattice))
    }

    /// Makes `count` samples of equal weight, distributed like the filter (filter importance
    /// sampling: Ernst, Stamminger and Greiner, 2006).
    ///
    /// They are the points of a rank-1 lattice in the unit square (Dammertz and Keller, Image
    /// Synthesis by Rank-1 Lattices, 2008), each coordinate mapped by the inverse of the filter's
    /// distribution. No two share a row or a column, so an edge along an axis is resolved into
    /// `count` levels; a square lattice of as many samples resolves it into the square root of
    /// that.
    fn importance(count: u32) -> Self {
        let generator = rank1_generator(count);
        // The samples are symmetric about the pixel's centre, so that a linear gradient is filtered
        // without error. For that, the row of the first column, `shift`, has to be as far from the
        // top as the row of the last column is from the bottom: 2 shift = generator - 1, modulo the
        // odd count.
        let shift = (u64::from(generator) + u64::from(count) - 1) * u64::from(count).div_ceil(2);
        let half_pixels =
            |i: u64| S::from_f64(2.0 * filter_quantile((i as f64 + 0.5) / f64::from(count)));
        let row = |column: u64| {
            let row = (column * u64::from(generator) + shift) % u64::from(count);
            Row {
                dy: half_pixels(row),
                weight: S::from_f64(1.0 / f64::from(count)),
                samples: vec![Sample { dx: half_pixels(column), weight: S::from_f64(1.0) }],
            }
        };
        Self::of_rows((0..u64::from(count)).map(row).collect(), 1, None)
    }
}

/// Returns the generator `g` of the best rank-1 lattice of `count` points, an odd number.
///
/// The points `(i, i g)` modulo `count` lie in different rows, and their smallest distance from
/// each other, across the edges too, is the largest possible.
fn rank1_generator(count: u32) -> u32 {
    let around = |x: u64| x.min(u64::from(count) - x).pow(2);
    let distance = |g: u32| {
        let points =
            (1..u64::from(count)).map(|i| around(i) + around(i * u64::from(g) % u64::from(count)));
        points.min().unwrap_or(0)
    };
    let one_a_row = |g: &u32| greatest_common_divisor(*g, count) == 1;
    // Generators above the middle give mirror images. Takes the first of equally good ones.
    (1..=count / 2).filter(one_a_row).rev().max_by_key(|&g| distance(g)).unwrap_or(1)
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Returns the position, in pixels from -1 to 1, below which the share `share` of the filter lies
/// in one coordinate: the inverse of `(1 + erf(x / 0.8) / erf(1 / 0.8)) / 2`.
fn filter_quantile(share: f64) -> f64 {
    let wanted = (2.0 * share - 1.0).abs() * libm::erf(1.0 / 0.8);
    // Bisection is slow, but gives the same bits on every machine.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = f64::midpoint(low, high);
        if libm::erf(middle / 0.8) < wanted { low = middle } else { high = middle }
    }
    if share < 0.5 { -high } else { low }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Sampling;

    fn importance(count: u32) -> Vec<(f64, f64)> {
        let filter = Filter::<f64>::importance(count);
        filter.rows.iter().map(|row| (row.samples[0].dx / 2.0, row.dy / 2.0)).collect()
    }

    /// Catches a sum other than 1, of either pattern: a plain surface would change its colour.
    #[test]
    fn the_weights_sum_to_one() {
        for antialiasing in [0, 1, 2, 5, 32] {
            for sampling in [Sampling::Lattice, Sampling::Importance] {
                let settings =
                    RenderSettings { antialiasing, sampling, ..RenderSettings::default() };
                let filter = Filter::<f64>::new(&settings);
                let rows = filter.rows.iter();
                let sum: f64 =
                    rows.map(|r| r.weight * r.samples.iter().map(|s| s.weight).sum::<f64>()).sum();
                assert!((sum - 1.0).abs() < 1e-13, "{sampling:?} {antialiasing}: {sum}");
                let count: usize = filter.rows.iter().map(|row| row.samples.len()).sum();
                assert_eq!(
                    count,
                    settings.rays_per_pixel() as usize,
                    "{sampling:?} {antialiasing}"
                );
            }
        }
    }

    /// Catches a shift that breaks the symmetry, a generator that puts two samples into one row,
    /// and a position outside of the filter.
    #[test]
    fn importance_samples_are_symmetric_and_in_rows_of_their_own() {
        for count in [1, 5, 9, 13, 25, 41, 145, 289, 1089] {
            let mut positions = importance(count);
            assert!(positions.iter().all(|(x, y)| x.abs() < 1.0 && y.abs() < 1.0));
            for (x, y) in &positions {
                let opposite =
                    positions.iter().any(|(a, b)| (a + x).abs() < 1e-15 && (b + y).abs() < 1e-15);
                assert!(opposite, "{count}: ({x}, {y}) has no opposite");
            }
            positions.sort_by(|a, b| a.1.total_cmp(&b.1));
            assert!(
                positions.windows(2).all(|pair| pair[0].1 < pair[1].1),
                "{count}: two samples in a row"
            );
        }
    }

    /// Catches a quantile of another function: the moments of the samples tend to the filter's.
    #[test]
    fn importance_samples_have_the_filter_s_second_moment() {
        // Simpson's rule over the filter in one coordinate.
        let steps = 2000;
        let simpson = |f: &dyn Fn(f64) -> f64| -> f64 {
            let weight =
                |i: i32| if i == 0 || i == steps { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            (0..=steps).map(|i| weight(i) * f(f64::from(i) / f64::from(steps))).sum()
        };
        let filter = |x: f64| libm::exp(-x * x / 0.64);
        let moment = simpson(&|x| x * x * filter(x)) / simpson(&filter);
        let positions = importance(4225);
        let found = |of: fn(&(f64, f64)) -> f64| {
            positions.iter().map(of).map(|x| x * x).sum::<f64>() / positions.len() as f64
        };
        assert!(
            (found(|p| p.0) - moment).abs() < 1e-6,
            "{} in x, {moment} expected",
            found(|p| p.0)
        );
        assert!(
            (found(|p| p.1) - moment).abs() < 1e-6,
            "{} in y, {moment} expected",
            found(|p| p.1)
        );
    }

    /// Catches a search that stops at a smaller distance. The best squared distances were found by
    /// trying all generators.
    #[test]
    fn the_generator_keeps_points_apart() {
        for (count, apart) in
            [(5, 5), (13, 13), (25, 25), (41, 41), (61, 65), (85, 85), (113, 125), (2113, 2378)]
        {
            let generator = rank1_generator(count);
            let square = |i: u32| (i * generator % count).min(count - i * generator % count).pow(2);
            let nearest = (1..=count / 2).map(|i| i * i + square(i)).min();
            assert_eq!(nearest, Some(apart), "{count}");
        }
        assert_eq!(rank1_generator(1), 1);
    }
}
