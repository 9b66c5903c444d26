//! From a position in the image to a ray.

use crate::ray::Ray;
use crate::scene::{self, unit};
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

/// The camera of a picture of a certain size and lattice density.
///
/// Positions are counted in half steps of the sampling lattice from the middle of the picture: whole
/// numbers, small enough to be exact in `f32`. So one lattice point is one pair of numbers,
/// whichever pixel asks for it, and gives one ray, to the bit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera<S> {
    position: Vector<S>,
    /// The unit direction of the middle of the screen.
    forward: Vector<S>,
    /// Half a lattice step to the right, on a screen at distance 1.
    x_step: Vector<S>,
    /// Half a lattice step downwards, on a screen at distance 1.
    y_step: Vector<S>,
}

impl<S: Scalar> Camera<S> {
    /// For pictures `width` pixels wide with `density` lattice steps a pixel.
    pub(crate) fn new(camera: &scene::Camera, width: u32, density: u32) -> Self {
        let view = unit(camera.look_at - camera.position);
        let right = unit(view.cross(unit(camera.up)));
        let up = right.cross(view);
        // Pixels are square: the step is the same in both directions. Only the ratio of the screen
        // to its distance matters, so no number is as large or small as these may be.
        let screen_width = camera.screen_width / camera.focal_length;
        let half_step = screen_width / (2.0 * f64::from(density) * f64::from(width));
        Self {
            position: Vector::rounded(camera.position),
            forward: Vector::rounded(view),
            x_step: Vector::rounded(right * half_step),
            y_step: Vector::rounded(-up * half_step),
        }
    }

    /// The ray through the point `x`, `y` half lattice steps from the middle of the screen.
    #[inline(always)]
    pub(crate) fn ray<L: Lane<Scalar = S>>(&self, x: L, y: L) -> Ray<L> {
        let across = Vector::splat(self.x_step) * x + Vector::splat(self.y_step) * y;
        Ray {
            origin: Vector::splat(self.position),
            direction: (Vector::splat(self.forward) + across).unit(),
        }
    }
}
