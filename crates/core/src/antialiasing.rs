//! The filter over the sampling lattice: `exp(-(dx^2 + dy^2) / 0.64)`, which is the product of the
//! same function of each coordinate, so that rows and columns are weighted one after the other.

use crate::lane::Scalar;

/// The weights of one row of samples, whose sum is 1 but for rounding; those of the rows are the same.
#[derive(Clone, Debug)]
pub(crate) struct Filter<S> {
    weights: Vec<S>,
    /// Lattice steps a pixel, 1 or more.
    density: u32,
}

impl<S: Scalar> Filter<S> {
    /// For a density `s` as in [`crate::scene::RenderSettings::antialiasing`].
    pub(crate) fn new(antialiasing: u32) -> Self {
        let density = antialiasing.max(1);
        let reach = f64::from(antialiasing);
        let steps = || (0..=2 * antialiasing).map(|i| (f64::from(i) - reach) / f64::from(density));
        // `libm` computes in software: the same bits on every machine.
        let weight = |offset: f64| libm::exp(-(offset * offset) / 0.64);
        let sum: f64 = steps().map(weight).sum();
        Self { weights: steps().map(|offset| S::from_f64(weight(offset) / sum)).collect(), density }
    }

    /// Lattice steps a pixel.
    pub(crate) fn density(&self) -> u32 {
        self.density
    }

    /// From the first to the last sample of a row, or row of a column.
    pub(crate) fn weights(&self) -> &[S] {
        &self.weights
    }
}
