//! Adaptive sampling: interpolates lattice points where the pixel centres around them look alike.
//!
//! A point between two centres depends on these two, a point amid four centres on the four. So
//! every tile decides alike, whichever point it computes.

use crate::render::lattice::LatticeSums;
use crate::render::samples::{Colors, SamplePositions, lattice_distance};
use crate::simd::lane::Scalar;

/// A row of pixel centres, with one more centre at either end.
#[derive(Clone, Debug)]
struct Centres<S> {
    colors: [Vec<S>; 3],
    path_hashes: Vec<u32>,
}

/// The lattice of a tile, computed band by band: a band reaches from one row of pixel centres to
/// the next.
pub(crate) struct Bands<S> {
    /// The number of lattice steps from one centre to the next.
    density: usize,
    /// The number of centres in a row.
    count: usize,
    above: Option<Centres<S>>,
    below: Option<Centres<S>>,
    /// Scratch space: one channel of the colours at the same offset right of each centre, above and
    /// below.
    mixed: [Vec<S>; 2],
}

impl<S: Scalar> Bands<S> {
    /// Makes the bands of a tile of `width` pixels, with `density` lattice steps a pixel.
    pub(crate) fn new(density: usize, width: usize) -> Self {
        Self { density, count: width + 2, above: None, below: None, mixed: Default::default() }
    }

    /// Lists the positions of the next row of centres, with y = 0.
    pub(crate) fn centre_positions(&self, positions: &mut SamplePositions<S>) {
        positions.clear();
        for centre in 0..self.count {
            positions.push(lattice_distance((centre * self.density) as i64), S::literal(0.0));
        }
    }

    /// Stores the colours and path hashes of the next row of centres.
    pub(crate) fn take_centres(&mut self, found: &Colors<S>) {
        let centres = Centres {
            colors: found.channels.each_ref().map(|channel| channel[..self.count].to_vec()),
            path_hashes: found.path_hashes[..self.count].to_vec(),
        };
        self.above = self.below.replace(centres);
    }

    /// Interpolates the band that ends with the newest row of centres, which is its last row.
    ///
    /// Afterwards `positions` lists the points whose centres differ, counted from the band's first
    /// row; `sums` expects their colours in this order.
    pub(crate) fn interpolate(
        &mut self,
        sums: &mut LatticeSums<'_, S>,
        positions: &mut SamplePositions<S>,
    ) {
        positions.clear();
        sums.start_strip(self.density);
        self.interpolate_all(sums);
        self.list_differing(sums, positions);
    }

    /// Interpolates every point of the band, also those whose centres differ: that is faster than
    /// to test each point.
    fn interpolate_all(&mut self, sums: &mut LatticeSums<'_, S>) {
        let (density, last) = (self.density, self.density - 1);
        let Some(below) = &self.below else { return };
        let share = |steps: usize| S::from_f64(steps as f64 / density as f64);
        let [top, bottom] = &mut self.mixed;
        for (dx, channel) in (0..density).flat_map(|dx| (0..3).map(move |channel| (dx, channel))) {
            let (next, across) = (usize::from(dx > 0), share(dx));
            let lerp_across = |centres: &Centres<S>, mixed: &mut Vec<S>| {
                let colors = &centres.colors[channel];
                let pairs = colors.iter().zip(&colors[next..]);
                mixed.clear();
                mixed.extend(pairs.map(|(&from, &to)| lerp(from, to, across)));
            };
            lerp_across(below, bottom);
            sums.points_mut(channel, dx, last)[..bottom.len()].copy_from_slice(bottom);
            // The lattice has no points above the first row of centres.
            let Some(above) = &self.above else { continue };
            lerp_across(above, top);
            for row in 0..last {
                let dy = share(row + 1);
                let points = sums.points_mut(channel, dx, row).iter_mut();
                for ((point, &top), &bottom) in points.zip(&*top).zip(&*bottom) {
                    *point = lerp(top, bottom, dy);
                }
            }
        }
    }

    /// Lists the points whose centres differ, cell by cell, so that the packets hold neighbours. A
    /// cell reaches from a centre to the next one to the right and the next one below.
    fn list_differing(&self, sums: &mut LatticeSums<'_, S>, positions: &mut SamplePositions<S>) {
        let (density, last) = (self.density, self.density - 1);
        let Some(below) = &self.below else { return };
        for centre in 0..self.count {
            let across = |centres: &Centres<S>| {
                centres.path_hashes.get(centre + 1) == Some(&centres.path_hashes[centre])
            };
            let alike_below = across(below);
            let alike_down = self
                .above
                .as_ref()
                .is_some_and(|above| above.path_hashes[centre] == below.path_hashes[centre]);
            let alike_above = self.above.as_ref().is_some_and(across);
            let alike = alike_above && alike_below && alike_down;
            if alike {
                continue;
            }
            let first_row = if self.above.is_some() { 0 } else { last };
            let columns = if centre + 1 < self.count { density } else { 1 };
            for (row, dx) in
                (first_row..density).flat_map(|row| (0..columns).map(move |dx| (row, dx)))
            {
                let known = match (row == last, dx == 0) {
                    (true, true) => true,
                    (true, false) => alike_below,
                    (false, true) => alike_down,
                    (false, false) => alike,
                };
                if !known {
                    let column = centre * density + dx;
                    positions.push(lattice_distance(column as i64), lattice_distance(row as i64));
                    sums.expect(column, row);
                }
            }
        }
    }
}

/// Returns the number at `share` of the way from one number to another.
#[inline(always)]
fn lerp<S: Scalar>(from: S, to: S, share: S) -> S {
    from + (to - from) * share
}
