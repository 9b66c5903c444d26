//! An estimate of the error that `f32` causes in a scene, and the precision that follows from it.

use crate::scene::{Cylinder, Plane, Scene, Sphere, Triangle, near_one, unit};
use crate::settings::Precision;
use glam::DVec3;
use std::fmt;

/// An estimate of how far `f32` errs in a scene, from the scene's numbers.
///
/// **Displacement.** Rays leave a surface by about 24 roundings of the coordinates across it:
/// twelve of the point's and twelve of the shape's. Along the surface, an outline is displaced by
/// one rounding of its coordinates, and a ray by four roundings of its length, which also cover the
/// eye. At a distance the image is `distance * screen_width / focal_length` wide. As a share of
/// this width, the displacement is
///
/// ```text
/// 2^-24 (24 across + along + 4 distance) / (distance * screen_width / focal_length)
/// ```
///
/// The displacement of the scene is that of the worst primitive, each taken at its point closest to
/// the eye. So coordinates may be of any size unless distances are small beside them, as far from
/// the origin of coordinates or close above a huge sphere. A long lens magnifies the error.
///
/// **Mirrors.** A curved mirror of radius `r` spreads what comes from a distance `d` by `2 d / r`.
/// An error grows about eightfold from one mirror to the next, and its effect shrinks by the share
/// that is mirrored. After all bounces, `bounces * log2(8 reflection)` digits are lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecisionEstimate {
    /// The largest displacement that `f32` causes, in widths of the image.
    pub displacement: f64,
    /// The binary digits that are lost between curved mirrors, 0 or more.
    pub mirrors: f64,
    /// The smallest number that is squared: a radius, the longest edge of a triangle or, if that is
    /// smaller, the largest coordinate. Infinite in an empty scene.
    pub least: f64,
    /// The largest magnitude of a number that is multiplied by others, at least 1: a coordinate of
    /// a primitive or a light, or a factor of a colour.
    pub extreme: f64,
}

/// The displacement up to which `f32` is enough: an eighth of a pixel of an image 500 pixels wide.
/// Up to here, images in `f32` had a PSNR of at least 60 dB against `f64`, and mostly 70 dB.
pub const F32_DISPLACEMENT: f64 = 1.0 / 4096.0;

/// The digits that `f32` may lose between mirrors: an image shows 8 of its 24.
pub const F32_MIRRORS: f64 = 16.0;

/// The magnitudes whose squares, and products of squares, `f32` can hold.
const F32_RANGE: std::ops::Range<f64> = 1e-9..1e9;

/// The lengths of a primitive that decide how far `f32` errs.
struct Extent {
    /// The radius or the longest edge; infinite for a plane.
    size: f64,
    /// The largest magnitude of a coordinate.
    reach: f64,
    /// The largest magnitude of a coordinate across the surface: of the terms whose difference is
    /// the eye's height above it.
    across: f64,
    /// The distance from the eye to the closest point of the primitive.
    distance: f64,
}

impl PrecisionEstimate {
    /// Estimates the error of `scene`. Looks at every coordinate once.
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
            // A plane has no outline: moved along itself, it looks the same.
            let along = if size.is_finite() { reach } else { 0.0 };
            // NaN comes from a plane through the eye and the origin. `max` ignores it, and the
            // plane is not visible.
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

    /// Returns the cheapest number type whose error an image in 8 bits does not show.
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
    /// Writes the reason for this precision, as the end of a sentence.
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
                "f32 is off by up to {displacement:.1e} of the image's width \
                 (allowed: {allowed:.1e})"
            )
        }
    }
}
