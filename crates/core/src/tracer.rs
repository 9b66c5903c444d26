//! The tracer as [`Work`]: any tile of a scene's picture.

use crate::antialiasing::Filter;
use crate::camera::Camera;
use crate::formulas::{Arithmetic, Family, Formulas, Robust, Textbook};
use crate::image::{Rgb, Tile};
use crate::lane::Scalar;
use crate::precision::Precision;
use crate::scene::{Scene, SceneError};
use crate::trace::World;
use crate::vector::Vector;
use crate::work::Work;

/// A scene ready to be rendered at one size in one arithmetic.
#[derive(Debug)]
struct Tracer<S, F> {
    world: World<S, F>,
    camera: Camera<S>,
    filter: Filter<S>,
    width: u32,
    height: u32,
}

/// The work of rendering `scene` into a picture of `width` x `height` pixels.
///
/// # Errors
///
/// A scene that [`Scene::check`] rejects.
pub fn tracer(
    scene: &Scene,
    width: u32,
    height: u32,
    arithmetic: impl Into<Arithmetic>,
) -> Result<Box<dyn Work + Send>, SceneError> {
    scene.check()?;
    let Arithmetic { formulas, precision } = arithmetic.into();
    Ok(match (formulas, precision) {
        (Formulas::Robust, Precision::F32) => Box::new(Tracer::<f32, Robust>::new(scene, width, height)),
        (Formulas::Robust, Precision::F64) => Box::new(Tracer::<f64, Robust>::new(scene, width, height)),
        (Formulas::Textbook, Precision::F32) => Box::new(Tracer::<f32, Textbook>::new(scene, width, height)),
        (Formulas::Textbook, Precision::F64) => Box::new(Tracer::<f64, Textbook>::new(scene, width, height)),
    })
}

impl<S: Scalar, F: Family> Tracer<S, F> {
    fn new(scene: &Scene, width: u32, height: u32) -> Self {
        let filter = Filter::new(scene.render.antialiasing);
        Self {
            world: World::new(scene),
            camera: Camera::new(&scene.camera, width, filter.density()),
            filter,
            width,
            height,
        }
    }

    /// The filtered samples around one pixel.
    ///
    /// Each row of samples is summed from the left, then the rows from the top: a fixed order, and
    /// one in which a row's sum could serve every pixel that needs it.
    fn pixel(&self, x: u32, y: u32) -> Rgb {
        let weights = self.filter.weights();
        let mut color = Vector::zero();
        for (j, &row_weight) in (0..).zip(weights) {
            let mut row = Vector::zero();
            for (i, &weight) in (0..).zip(weights) {
                row = row + self.sample(self.place(x, i, self.width), self.place(y, j, self.height)) * weight;
            }
            color = color + row * row_weight;
        }
        [color.x.to_f32(), color.y.to_f32(), color.z.to_f32()]
    }

    fn sample(&self, right: S, down: S) -> Vector<S> {
        self.world.trace(self.camera.ray(right, down), true)
    }

    /// Sample `i` of pixel `x` along an axis of `extent` pixels, in half lattice steps from the
    /// middle of the picture: a whole number below 2^23.
    fn place(&self, x: u32, i: i64, extent: u32) -> S {
        let density = i64::from(self.filter.density());
        let reach = self.filter.weights().len() as i64 / 2;
        let step = i64::from(x) * density + i - reach;
        S::from_f64((2 * step + density - density * i64::from(extent)) as f64)
    }
}

impl<S: Scalar, F: Family> Work for Tracer<S, F> {
    fn render(&self, tile: &mut Tile<'_>) {
        let left = tile.area().x;
        for (y, row) in tile.rows() {
            for (x, color) in (left..).zip(row) {
                *color = self.pixel(x, y);
            }
        }
    }
}
