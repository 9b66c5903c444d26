//! The tracer as [`Work`]: any tile of a scene's picture.

use crate::antialiasing::Filter;
use crate::camera::Camera;
use crate::formulas::{Arithmetic, Compiled, Family};
use crate::image::{Rgb, Tile};
use crate::lane::Scalar;
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
    Ok(arithmetic.into().select(Picture { scene, width, height }))
}

/// What a tracer is compiled for.
struct Picture<'a> {
    scene: &'a Scene,
    width: u32,
    height: u32,
}

impl Compiled for Picture<'_> {
    type Output = Box<dyn Work + Send>;

    fn compiled<S: Scalar, F: Family>(self) -> Self::Output {
        let Picture { scene, width, height } = self;
        let filter = Filter::new(&scene.render);
        Box::new(Tracer::<S, F> {
            world: World::new(scene),
            camera: Camera::new(&scene.camera, width, filter.density()),
            filter,
            width,
            height,
        })
    }
}

impl<S: Scalar, F: Family> Tracer<S, F> {
    /// The filtered samples around one pixel.
    ///
    /// Each row of samples is summed from the left, then the rows from the top: a fixed order, and
    /// one in which a row's sum could serve every pixel that needs it.
    fn pixel(&self, x: u32, y: u32) -> Rgb {
        let (right, down) = (self.centre(x, self.width), self.centre(y, self.height));
        let mut color = Vector::zero();
        for row in self.filter.rows() {
            let mut row_color = Vector::zero();
            for sample in &row.samples {
                let ray = self.camera.ray(right + sample.right, down + row.down);
                row_color = row_color + self.world.trace(ray, true) * sample.weight;
            }
            color = color + row_color * row.weight;
        }
        [color.x.to_f32(), color.y.to_f32(), color.z.to_f32()]
    }

    /// The centre of pixel `x` along an axis of `extent` pixels, in half steps of the filter's from the
    /// middle of the picture: a whole number below 2^23. So places on the lattice are exact in `f32`; others
    /// are rounded there, to 1/512 of a pixel in the widest picture and 1/65536 in one of 500.
    fn centre(&self, x: u32, extent: u32) -> S {
        let half_pixels = 2 * i64::from(x) + 1 - i64::from(extent);
        S::from_f64((i64::from(self.filter.density()) * half_pixels) as f64)
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
