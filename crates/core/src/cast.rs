//! Single rays through the kernel that renders, for tests and studies.

use crate::execution::Acceleration;
use crate::formulas::{Compiled, Family, select};
use crate::ray::Ray;
use crate::scene::{Scene, SceneError, near_one};
use crate::simd::lane::Scalar;
use crate::simd::vector::Vector;
use crate::trace::World;
use glam::DVec3;

/// The closest hit of a single ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance in units of the ray's direction, above 0.
    pub t: f64,
    /// The number of the primitive, counted from 0 through planes, spheres, triangles and
    /// cylinders, each in file order.
    pub primitive: usize,
    /// The point of the hit, moved onto the surface.
    pub point: DVec3,
    /// The unit normal, pointing against the ray.
    pub normal: DVec3,
}

/// A scene ready for single rays.
pub struct Caster(Box<dyn Cast + Send + Sync>);

impl Caster {
    /// Prepares `scene` in its own arithmetic: all its numbers are rounded to the precision.
    ///
    /// # Errors
    ///
    /// A scene that [`Scene::check`] rejects.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        scene.check()?;
        Ok(Self::of(scene))
    }

    /// Prepares the scene. It is not generic, so that the kernels are compiled in this crate and
    /// not again in each crate that uses it.
    fn of(scene: &Scene) -> Self {
        Self(select(scene.render.arithmetic, scene))
    }

    /// Returns the closest hit of the ray from `origin` in `direction`, which may have any length.
    ///
    /// Both are first rounded to the precision. A zero direction hits nothing, and neither does a
    /// ray with a number that is not finite.
    #[must_use]
    pub fn closest_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        if !(origin.is_finite() && direction.is_finite()) {
            return None;
        }
        self.0.closest_hit(origin, direction)
    }

    /// Returns the colour, linear and not clamped, that the ray from `origin` in `direction` brings
    /// back. The direction is made unit.
    #[must_use]
    pub fn color(&self, origin: DVec3, direction: DVec3) -> [f64; 3] {
        self.0.color(origin, direction)
    }
}

impl Compiled for &Scene {
    type Output = Box<dyn Cast + Send + Sync>;

    fn compiled<S: Scalar, F: Family>(self) -> Self::Output {
        Box::new(World::<S, F>::new(self, None, Acceleration::Auto))
    }
}

/// A scene ready for single rays, in any arithmetic.
pub(crate) trait Cast {
    fn closest_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;
    fn color(&self, origin: DVec3, direction: DVec3) -> [f64; 3];
}

impl<S: Scalar, F: Family> Cast for World<S, F> {
    fn closest_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        // Scales the longest component to about 1, by a power of two, which rounds nothing: the
        // squares of a very long or short direction would over- or underflow. The renderer's own
        // directions are unit, or reach from a point to a light.
        let (_, exponent) = libm::frexp(direction.abs().max_element());
        let ray = Ray::<S> {
            origin: Vector::rounded(origin),
            direction: Vector::rounded(near_one(direction)),
        };
        let hit = self.primitives.closest_hit::<S, F>(&ray, true, None);
        hit.exists().then(|| {
            let at = self.primitives.surface::<S, F>(hit.primitive, &ray, hit.t);
            Hit {
                t: libm::scalbn(hit.t.to_f64(), -exponent),
                primitive: hit.primitive as usize,
                point: at.point.widened(),
                normal: at.normal.widened(),
            }
        })
    }

    fn color(&self, origin: DVec3, direction: DVec3) -> [f64; 3] {
        let direction = Vector::<S>::rounded(direction).unit();
        self.trace(Ray { origin: Vector::rounded(origin), direction }, true, false)
            .color
            .widened()
            .to_array()
    }
}
