//! Single rays through the kernel that renders, for tests and for whoever studies it.

use crate::execution::Acceleration;
use crate::formulas::{Compiled, Family, select};
use crate::ray::Ray;
use crate::scene::{Scene, SceneError, near_one};
use crate::simd::lane::Scalar;
use crate::simd::vector::Vector;
use crate::trace::World;
use glam::DVec3;

/// Where a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// In units of the ray's direction, above 0.
    pub t: f64,
    /// The primitive's number: planes, spheres, triangles, cylinders, each in file order, from 0.
    pub primitive: usize,
    /// The point, moved onto the surface.
    pub point: DVec3,
    /// The unit normal, turned against the ray.
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

    /// Not generic, so that all that is compiled for it is compiled in this crate, and in none that
    /// uses it.
    fn of(scene: &Scene) -> Self {
        Self(select(scene.render.arithmetic, scene))
    }

    /// Returns the closest hit of the ray from `origin` in `direction`, which may have any length but 0.
    /// Both are first rounded to the precision. A zero direction hits nothing, nor does what is not
    /// finite.
    #[must_use]
    pub fn closest_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        if !(origin.is_finite() && direction.is_finite()) {
            return None;
        }
        self.0.closest_hit(origin, direction)
    }

    /// The colour, linear and not clamped, that comes back along the ray from `origin` in
    /// `direction`, which is made unit.
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

pub(crate) trait Cast {
    fn closest_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;
    fn color(&self, origin: DVec3, direction: DVec3) -> [f64; 3];
}

impl<S: Scalar, F: Family> Cast for World<S, F> {
    fn closest_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        // The longest component is brought near 1 by a power of two, which rounds nothing: the
        // squares of a very long or short direction would over- or underflow. The renderer's own
        // are unit, or reach from a point to a light.
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
