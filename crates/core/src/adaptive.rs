//! Lattice points that need no ray: where the pixel centres around them look alike, they are interpolated.
//!
//! A point between two centres is decided by these two, one amid four centres by the four. So whoever computes it
//! decides alike, whichever tile it is in.

use crate::lane::Scalar;
use crate::lattice::LatticeSums;
use crate::samples::{Colors, Places, half_steps};
use crate::vector::Vector;

/// The centres of a row of pixels and of one more on either side.
#[derive(Clone, Debug)]
struct Centres<S> {
    colors: Vec<Vector<S>>,
    trails: Vec<u32>,
}

/// The lattice of a tile, band by band: from one row of pixel centres down to the next.
pub(crate) struct Bands<S> {
    /// Lattice steps from one centre to the next.
    density: usize,
    /// Of centres in a row.
    count: usize,
    above: Option<Centres<S>>,
    below: Option<Centres<S>>,
    /// Column and row, within the band, of the points that are traced, in their order.
    traced: Vec<(usize, usize)>,
}

impl<S: Scalar> Bands<S> {
    /// For a tile of `width` pixels, with `density` steps a pixel.
    pub(crate) fn new(density: usize, width: usize) -> Self {
        Self { density, count: width + 2, above: None, below: None, traced: Vec::new() }
    }

    /// The places of the next row of centres, on row 0.
    pub(crate) fn place_centres(&self, places: &mut Places<S>) {
        places.clear();
        for centre in 0..self.count {
            places.push(half_steps((centre * self.density) as i64), S::literal(0.0));
        }
    }

    /// Takes over their colours.
    pub(crate) fn take_centres(&mut self, found: &Colors<S>) {
        let centres = Centres {
            colors: (0..self.count).map(|i| found.get(i)).collect(),
            trails: found.trails[..self.count].to_vec(),
        };
        self.above = self.below.replace(centres);
    }

    /// Interpolates what can be of the band that ends with the row of centres, its last row; `places` are those of all
    /// other points, counted from its first row.
    pub(crate) fn interpolate(&mut self, sums: &mut LatticeSums<'_, S>, places: &mut Places<S>) {
        let (density, last) = (self.density, self.density - 1);
        places.clear();
        self.traced.clear();
        let Some(below) = &self.below else { return };
        let share = |steps: usize| S::from_f64(steps as f64 / density as f64);
        for row in 0..density {
            for column in 0..=density * (self.count - 1) {
                let (centre, aside) = (column / density, column % density);
                let right = centre + usize::from(aside > 0);
                let known = if row == last {
                    between(below, centre, right, share(aside))
                } else {
                    self.above.as_ref().and_then(|above| {
                        let alike = above.trails[centre] == below.trails[centre];
                        let top = between(above, centre, right, share(aside))?;
                        let bottom = between(below, centre, right, share(aside))?;
                        alike.then(|| mix(top, bottom, share(row + 1)))
                    })
                };
                // Above the first row of centres the lattice has nothing.
                let exists = row == last || self.above.is_some();
                match known {
                    Some(color) => sums.set(column, row, color),
                    None if exists => {
                        places.push(half_steps(column as i64), half_steps(row as i64));
                        self.traced.push((column, row));
                    }
                    None => {}
                }
            }
        }
    }

    /// Takes over the colours of the points that were traced.
    pub(crate) fn take_traced(&self, found: &Colors<S>, sums: &mut LatticeSums<'_, S>) {
        for (i, &(column, row)) in self.traced.iter().enumerate() {
            sums.set(column, row, found.get(i));
        }
    }
}

/// The colour at `share` of the way between two centres that look alike; of a centre itself, its own.
fn between<S: Scalar>(centres: &Centres<S>, left: usize, right: usize, share: S) -> Option<Vector<S>> {
    let alike = centres.trails[left] == centres.trails[right];
    alike.then(|| mix(centres.colors[left], centres.colors[right], share))
}

fn mix<S: Scalar>(from: Vector<S>, to: Vector<S>, share: S) -> Vector<S> {
    from + (to - from) * share
}
