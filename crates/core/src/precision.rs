//! How many digits a scene needs.

use crate::scene::Scene;
use std::fmt;

/// The number type that a picture is computed in; pictures are kept as `f32` in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 24 binary digits.
    F32,
    /// 53 binary digits.
    F64,
}

/// What a scene asks of a number type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// The largest magnitude of a coordinate that something visible has, or the eye.
    pub largest: f64,
    /// The smallest radius, or longest edge of a triangle; infinite for a scene of planes.
    pub smallest: f64,
    /// The largest magnitude of any number that is multiplied by others: a coordinate, of a light
    /// too, or a factor of a colour.
    pub extreme: f64,
}

/// The ratio of the largest coordinate to the smallest feature up to which `f32` is enough.
///
/// A point is known to about 16 roundings of its largest coordinate, `2^-20` of it. With a ratio
/// of `2^12` that is `2^-8` of the smallest feature, which 8 bits do not show.
pub const F32_RATIO: f64 = 4096.0;

/// Magnitudes whose squares, and the squares' products, `f32` can hold.
const F32_RANGE: std::ops::Range<f64> = 1e-9..1e9;

impl Demand {
    /// Looks at every coordinate of `scene` once.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let mut demand = Self {
            largest: scene.camera.position.abs().max_element(),
            smallest: f64::INFINITY,
            extreme: 1.0,
        };
        let mut see = |coordinate: f64, feature: f64| {
            demand.largest = demand.largest.max(coordinate);
            demand.smallest = demand.smallest.min(feature);
        };
        for plane in &scene.planes {
            see(plane.point.abs().max_element(), f64::INFINITY);
        }
        for sphere in &scene.spheres {
            see(sphere.center.abs().max_element() + sphere.radius, sphere.radius);
        }
        for triangle in &scene.triangles {
            let [a, b, c] = triangle.vertices;
            let longest_edge = (b - a).length().max((c - b).length()).max((a - c).length());
            see(a.abs().max(b.abs()).max(c.abs()).max_element(), longest_edge);
        }
        for cylinder in &scene.cylinders {
            let ends = cylinder.bottom.abs().max(cylinder.top.abs());
            see(ends.max_element() + cylinder.radius, cylinder.radius);
        }
        let lights = scene.lights.iter().flat_map(|light| [light.position.abs().max_element(), light.power]);
        let factors = scene.materials.iter().flat_map(|m| [m.ambient, m.diffuse, m.specular]);
        demand.extreme = lights.chain(factors).fold(demand.largest.max(1.0), f64::max);
        demand
    }

    /// The smallest feature or, in a scene without any, the largest coordinate.
    fn least(&self) -> f64 {
        if self.largest == 0.0 { self.smallest } else { self.smallest.min(self.largest) }
    }

    /// The cheapest number type whose error a picture in 8 bits does not show.
    #[must_use]
    pub fn precision(&self) -> Precision {
        let fits = self.extreme <= F32_RANGE.end && self.least() >= F32_RANGE.start;
        if fits && self.largest <= F32_RATIO * self.smallest { Precision::F32 } else { Precision::F64 }
    }
}

impl fmt::Display for Demand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { largest, smallest, extreme } = self;
        if *extreme > F32_RANGE.end || self.least() < F32_RANGE.start {
            return write!(
                f,
                "numbers from {:e} to {extreme:e} (f32: {:e} to {:e})",
                self.least().min(1.0),
                F32_RANGE.start,
                F32_RANGE.end
            );
        }
        if smallest.is_infinite() {
            return write!(f, "largest coordinate {largest}, nothing small");
        }
        let ratio = largest / smallest;
        write!(
            f,
            "largest coordinate {largest:.4} is {ratio:.0} times the smallest feature {smallest:.4} (f32: up to {F32_RATIO})"
        )
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}
