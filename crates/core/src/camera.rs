//! The camera: turns a position in the image into a ray.

use crate::ray::Ray;
use crate::scene::{self, unit};
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

/// The camera of an image of a certain size and lattice density.
///
/// Positions are counted in half lattice steps from the middle of the image. They are whole
/// numbers, small enough to be exact in `f32`, so a lattice point is the same pair of numbers for
/// every pixel that needs it, and gives the same ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera<S> {
    position: Vector<S>,
    /// The unit direction to the middle of the screen.
    forward: Vector<S>,
    /// The vector of half a lattice step to the right, on a screen at distance 1.
    x_step: Vector<S>,
    /// The vector of half a lattice step down, on a screen at distance 1.
    y_step: Vector<S>,
}

impl<S: Scalar> Camera<S> {
    /// Makes the camera of images `width` pixels wide with `density` lattice steps a pixel.
    pub(crate) fn new(camera: &scene::Camera, width: u32, density: u32) -> Self {
        let view = unit(camera.look_at - camera.position);
        let right = unit(view.cross(unit(camera.up)));
        let up = right.cross(view);
        // Pixels are square, so the step has the same length in both directions. Only the ratio of
        // the screen's width to its distance matters; taking it first avoids very large and very
        // small numbers.
        let screen_width = camera.screen_width / camera.focal_length;
        let half_step = screen_width / (2.0 * f64::from(density) * f64::from(width));
        Self {
            position: Vector::rounded(camera.position),
            forward: Vector::rounded(view),
            x_step: Vector::rounded(right * half_step),
            y_step: Vector::rounded(-up * half_step),
        }
    }

    /// Returns the ray through the position `x`, `y`, with unit direction.
    #[inline(always)]
    pub(crate) fn ray<L: Lane<Scalar = S>>(&self, x: L, y: L) -> Ray<L> {
        let across = Vector::splat(self.x_step) * x + Vector::splat(self.y_step) * y;
        Ray {
            origin: Vector::splat(self.position),
            direction: (Vector::splat(self.forward) + across).unit(),
        }
    }
}
