//! Lattice points that need no ray: where the pixel centres around them look alike, they are
//! interpolated.
//!
//! A point between two centres is decided by these two, one amid four centres by the four. So
//! whoever computes it decides alike, whichever tile it is in.

use crate::render::lattice::LatticeSums;
use crate::render::samples::{Colors, SamplePositions, lattice_distance};
use crate::simd::lane::Scalar;

/// The centres of a row of pixels and of one more on either side.
#[derive(Clone, Debug)]
struct Centres<S> {
    colors: [Vec<S>; 3],
    path_hashes: Vec<u32>,
}

/// The lattice of a tile, band by band: from one row of pixel centres down to the next.
pub(crate) struct Bands<S> {
    /// Lattice steps from one centre to the next.
    density: usize,
    /// Of centres in a row.
    count: usize,
    above: Option<Centres<S>>,
    below: Option<Centres<S>>,
    /// For a moment: the colours in one channel so many steps right of each centre, above and
    /// below.
    mixed: [Vec<S>; 2],
}

impl<S: Scalar> Bands<S> {
    /// For a tile of `width` pixels, with `density` steps a pixel.
    pub(crate) fn new(density: usize, width: usize) -> Self {
        Self { density, count: width + 2, above: None, below: None, mixed: Default::default() }
    }

    /// The positions of the next row of centres, on row 0.
    pub(crate) fn position_centres(&self, positions: &mut SamplePositions<S>) {
        positions.clear();
        for centre in 0..self.count {
            positions.push(lattice_distance((centre * self.density) as i64), S::literal(0.0));
        }
    }

    /// Takes over their colours and path hashes.
    pub(crate) fn take_centres(&mut self, found: &Colors<S>) {
        let centres = Centres {
            colors: found.channels.each_ref().map(|channel| channel[..self.count].to_vec()),
            path_hashes: found.path_hashes[..self.count].to_vec(),
        };
        self.above = self.below.replace(centres);
    }

    /// Interpolates the band that ends with the row of centres, its last row. `positions` are those of
    /// the points whose centres do not look alike, counted from its first row: their colours are
    /// what `sums` expects.
    pub(crate) fn interpolate(
        &mut self,
        sums: &mut LatticeSums<'_, S>,
        positions: &mut SamplePositions<S>,
    ) {
        positions.clear();
        sums.start_strip(self.density);
        self.interpolate_all(sums);
        self.position_unlike(sums, positions);
    }

    /// Every point, also where the centres do not look alike: all together, that is quicker than to
    /// ask of each.
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
            // Above the first row of centres the lattice has nothing.
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

    /// SamplePositions the points whose centres do not look alike, cell by cell, each from a centre to the
    /// next one right and the next one down: so those that follow each other are neighbours.
    fn position_unlike(&self, sums: &mut LatticeSums<'_, S>, positions: &mut SamplePositions<S>) {
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

/// The number at `share` of the way from one to another.
#[inline(always)]
fn lerp<S: Scalar>(from: S, to: S, share: S) -> S {
    from + (to - from) * share
}
