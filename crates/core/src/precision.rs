//! How many digits a scene needs.

use crate::scene::{Cylinder, Plane, Scene, Sphere, Triangle, near_one, unit};
use crate::settings::Precision;
use glam::DVec3;
use std::fmt;

/// What a scene asks of a number type.
///
/// **Displacement.** Rays leave a surface by about 24 roundings of the coordinates across it:
/// twelve of the point's and twelve of the shape's. Along it an outline is displaced by one
/// rounding of its coordinates, and a ray by four of its length, which cover the eye. From a
/// distance the picture is `distance * screen_width / focal_length` wide; of this width, that is
///
/// ```text
/// 2^-24 (24 across + along + 4 distance) / (distance * screen_width / focal_length)
/// ```
///
/// The scene's displacement is that of the worst primitive, each at its point next to the eye. So
/// coordinates may be of any size, but not beside small distances: far from the origin of
/// coordinates, close above a huge sphere. A long lens magnifies what there is.
///
/// **Mirrors.** A curved mirror of radius `r` spreads what comes from a distance `d` by `2 d / r`:
/// an error grows about eightfold from one to the next, and what it is an error of counts less by
/// the share that is mirrored. After all bounces that takes `bounces * log2(8 reflection)` digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecisionEstimate {
    /// How far `f32` displaces what is seen, at most, in widths of the picture.
    pub displacement: f64,
    /// The binary digits that are lost between curved mirrors, 0 or more.
    pub mirrors: f64,
    /// The smallest number that is squared: a radius, the longest edge of a triangle or, if it is
    /// smaller, the largest coordinate. Infinite if there is nothing.
    pub least: f64,
    /// The largest magnitude of any number that is multiplied by others, at least 1: a coordinate,
    /// of a light too, or a factor of a colour.
    pub extreme: f64,
}

/// The displacement up to which `f32` is enough: the eighth of a pixel of a picture 500 wide. Up to
/// here, pictures in `f32` were 60 dB and more from those in `f64`, and mostly 70.
pub const F32_DISPLACEMENT: f64 = 1.0 / 4096.0;

/// The digits that `f32` may lose between mirrors: of its 24, a picture shows 8.
pub const F32_MIRRORS: f64 = 16.0;

/// Magnitudes whose squares, and the squares' products, `f32` can hold.
const F32_RANGE: std::ops::Range<f64> = 1e-9..1e9;

/// What a primitive has to do with precision.
struct Extent {
    /// A radius or the longest edge; infinite for a plane.
    size: f64,
    /// The largest magnitude of a coordinate.
    reach: f64,
    /// The same across the surface: of what is subtracted to find the height of the eye above it.
    across: f64,
    /// From the eye to the point next to it.
    distance: f64,
}

impl PrecisionEstimate {
    /// Looks at every coordinate of `scene` once.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let eye = scene.camera.position;
        let view = scene.camera.screen_width / scene.camera.focal_length;
        let (mut largest, mut smallest, mut roundings) =
            (largest_of(eye), f64::INFINITY, 4.0 / view);
        let extents = (scene.planes.iter().map(|plane| Extent::of_plane(plane, eye)))
            .chain(scene.spheres.iter().map(|sphere| Extent::of_sphere(sphere, eye)))
            .chain(scene.triangles.iter().map(|triangle| Extent::of_triangle(triangle, eye)))
            .chain(scene.cylinders.iter().map(|cylinder| Extent::of_cylinder(cylinder, eye)));
        for Extent { size, reach, across, distance } in extents {
            largest = largest.max(reach);
            smallest = smallest.min(size);
            // A plane has no outline: it looks the same moved along itself.
            let along = if size.is_finite() { reach } else { 0.0 };
            // NaN, for a plane through the eye and the origin, is not seen by `max`, nor the plane.
            roundings = roundings.max((24.0 * across + along + 4.0 * distance) / (distance * view));
        }
        let curved = scene.spheres.iter().map(|s| s.material);
        let curved = curved.chain(scene.cylinders.iter().map(|c| c.material));
        let reflection =
            curved.map(|material| scene.materials[material].reflection).fold(0.0, f64::max);
        let lights =
            scene.lights.iter().flat_map(|light| [largest_of(light.position), light.power]);
        let factors = scene.materials.iter().flat_map(|m| [m.ambient, m.diffuse, m.specular]);
        Self {
            displacement: roundings / 2f64.powi(24),
            mirrors: f64::from(scene.render.max_reflections)
                * libm::log2((8.0 * reflection).max(1.0)),
            least: if largest == 0.0 { smallest } else { smallest.min(largest) },
            extreme: lights.chain(factors).fold(largest.max(1.0), f64::max),
        }
    }

    fn in_range(&self) -> bool {
        self.extreme <= F32_RANGE.end && self.least >= F32_RANGE.start
    }

    /// The cheapest number type whose error a picture in 8 bits does not show.
    #[must_use]
    pub fn precision(&self) -> Precision {
        let enough = self.displacement <= F32_DISPLACEMENT && self.mirrors <= F32_MIRRORS;
        if self.in_range() && enough { Precision::F32 } else { Precision::F64 }
    }
}

impl Extent {
    fn of_plane(plane: &Plane, eye: DVec3) -> Self {
        let normal = unit(plane.normal);
        Self {
            size: f64::INFINITY,
            reach: largest_of(plane.point),
            across: normal.abs().dot(plane.point.abs()),
            distance: normal.dot(plane.point - eye).abs(),
        }
    }

    fn of_sphere(sphere: &Sphere, eye: DVec3) -> Self {
        let (center, radius) = (largest_of(sphere.center), sphere.radius);
        Self {
            size: radius,
            reach: center + radius,
            across: center.max(radius),
            distance: (sphere.center.distance(eye) - radius).abs(),
        }
    }

    fn of_triangle(triangle: &Triangle, eye: DVec3) -> Self {
        let [a, b, c] = triangle.vertices;
        let sides = [(a, b), (b, c), (c, a)];
        let normal = unit(near_one(b - a).cross(near_one(c - a)));
        let reach = a.abs().max(b.abs()).max(c.abs());
        let above = sides.iter().all(|&(from, to)| normal.cross(to - from).dot(eye - from) >= 0.0);
        Self {
            size: sides.iter().map(|(from, to)| from.distance(*to)).fold(0.0, f64::max),
            reach: reach.max_element(),
            across: normal.abs().dot(reach),
            distance: if above {
                normal.dot(eye - a).abs()
            } else {
                sides
                    .iter()
                    .map(|&side| distance_to_segment(eye, side))
                    .fold(f64::INFINITY, f64::min)
            },
        }
    }

    fn of_cylinder(cylinder: &Cylinder, eye: DVec3) -> Self {
        let Cylinder { bottom, top, radius, .. } = *cylinder;
        let to_axis = (eye.x - bottom.x).hypot(eye.z - bottom.z);
        let beyond_end = eye.y - eye.y.clamp(bottom.y, top.y);
        Self {
            size: radius,
            reach: largest_of(bottom.abs().max(top.abs())) + radius,
            across: bottom.x.abs().max(bottom.z.abs()).max(radius),
            distance: (to_axis - radius).hypot(beyond_end),
        }
    }
}

fn largest_of(v: DVec3) -> f64 {
    v.abs().max_element()
}

fn distance_to_segment(point: DVec3, (from, to): (DVec3, DVec3)) -> f64 {
    let share = (point - from).dot(to - from) / (to - from).length_squared();
    point.distance(from.lerp(to, share.clamp(0.0, 1.0)))
}

impl fmt::Display for PrecisionEstimate {
    /// Why this precision, as the end of a sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { displacement, mirrors, least, extreme } = self;
        let (allowed, range) = (F32_DISPLACEMENT, F32_RANGE);
        if !self.in_range() {
            let (from, to) = (range.start, range.end);
            write!(f, "numbers from {:e} to {extreme:e} (f32: {from:e} to {to:e})", least.min(1.0))
        } else if *mirrors > F32_MIRRORS && *displacement <= allowed {
            write!(
                f,
                "curved mirrors multiply errors by 2^{mirrors:.0} (f32: up to 2^{F32_MIRRORS})"
            )
        } else {
            write!(
                f,
                "f32 is off by up to {displacement:.1e} of the picture's width (allowed: {allowed:.1e})"
            )
        }
    }
}
