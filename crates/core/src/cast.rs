//! Single rays through the kernel that renders, for tests and for whoever studies it.

use crate::formulas::{Arithmetic, Family, Formulas, Robust, Textbook};
use crate::lane::Scalar;
use crate::precision::Precision;
use crate::primitives::Primitives;
use crate::ray::Ray;
use crate::scene::{Scene, SceneError, near_one};
use crate::trace::World;
use crate::vector::Vector;
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

/// The nearest hit of the ray from `origin` in `direction`, which may have any length but 0. All
/// numbers are first rounded to the precision. A zero direction, or one that is not finite, hits
/// nothing.
///
/// # Errors
///
/// A scene that [`Scene::check`] rejects.
pub fn nearest_hit(
    scene: &Scene,
    origin: DVec3,
    direction: DVec3,
    arithmetic: impl Into<Arithmetic>,
) -> Result<Option<Hit>, SceneError> {
    scene.check()?;
    let Arithmetic { formulas, precision } = arithmetic.into();
    Ok(match (formulas, precision) {
        (Formulas::Robust, Precision::F32) => nearest_hit_in::<f32, Robust>(scene, origin, direction),
        (Formulas::Robust, Precision::F64) => nearest_hit_in::<f64, Robust>(scene, origin, direction),
        (Formulas::Textbook, Precision::F32) => nearest_hit_in::<f32, Textbook>(scene, origin, direction),
        (Formulas::Textbook, Precision::F64) => nearest_hit_in::<f64, Textbook>(scene, origin, direction),
    })
}

fn nearest_hit_in<S: Scalar, F: Family>(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<Hit> {
    // The longest component is brought near 1 by a power of two, which rounds nothing: the squares
    // of a very long or short direction would over- or underflow. The renderer's own are unit, or
    // reach from a point to a light.
    let (_, exponent) = libm::frexp(direction.abs().max_element());
    let ray = Ray::<S> { origin: Vector::rounded(origin), direction: Vector::rounded(near_one(direction)) };
    let primitives = Primitives::new(scene);
    let hit = primitives.nearest::<S, F>(&ray);
    hit.exists().then(|| {
        let at = primitives.surface::<S, F>(hit.primitive, &ray, hit.t);
        Hit {
            t: libm::scalbn(hit.t.to_f64(), -exponent),
            primitive: hit.primitive as usize,
            point: at.point.widened(),
            normal: at.normal.widened(),
        }
    })
}

/// The colour, linear and not clamped, that comes back along the ray from `origin` in `direction`,
/// which is made unit. All numbers are first rounded to the precision.
///
/// # Errors
///
/// A scene that [`Scene::check`] rejects.
pub fn color(
    scene: &Scene,
    origin: DVec3,
    direction: DVec3,
    arithmetic: impl Into<Arithmetic>,
) -> Result<[f64; 3], SceneError> {
    scene.check()?;
    let Arithmetic { formulas, precision } = arithmetic.into();
    Ok(match (formulas, precision) {
        (Formulas::Robust, Precision::F32) => color_in::<f32, Robust>(scene, origin, direction),
        (Formulas::Robust, Precision::F64) => color_in::<f64, Robust>(scene, origin, direction),
        (Formulas::Textbook, Precision::F32) => color_in::<f32, Textbook>(scene, origin, direction),
        (Formulas::Textbook, Precision::F64) => color_in::<f64, Textbook>(scene, origin, direction),
    })
}

fn color_in<S: Scalar, F: Family>(scene: &Scene, origin: DVec3, direction: DVec3) -> [f64; 3] {
    let direction = Vector::<S>::rounded(direction).unit();
    let color = World::<S, F>::new(scene).trace(Ray { origin: Vector::rounded(origin), direction }, true);
    color.widened().to_array()
}
