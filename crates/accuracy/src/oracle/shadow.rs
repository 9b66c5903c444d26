//! Exact visibility: whether a surface lies strictly between two points.
//!
//! Numbers of scenes are `f64`, so almost no point that is written lies in a tilted surface, not
//! even the one that a scene means. A light counts as lying in the surface if it is closer to it
//! than `IN_SURFACE` roundings of the coordinates. Then the surface is moved, exactly, to pass
//! through the light, and meets the way to the light there, which hides nothing.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use glam::DVec3;
use rayweave_core::scene::{Cylinder, Plane, Sphere, Triangle};

use super::exact::{
    Surd, Vector, abs, cross, dot, dot_of_sizes, float, products, sign, subtract, sum,
};

/// The roundings of the coordinates, of 2^-53 each, within which a point lies in a surface.
const IN_SURFACE: f64 = 16.0;
/// The roundings from which on a point certainly does not.
const BESIDE: f64 = 64.0;
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// A surface that may lie between a point and a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Occluder {
    /// An infinite plane.
    Plane(Plane),
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Triangle(Triangle),
    /// The wall of a cylinder.
    Cylinder(Cylinder),
}

/// A surface that a light sees, exactly.
#[derive(Clone, Debug)]
pub struct ExactOccluder {
    light: Vector,
    surface: Surface,
}

#[derive(Clone, Debug)]
enum Surface {
    /// A plane, or the triangle with these corners in it.
    Flat { point: Vector, normal: Vector, corners: Option<Box<[Vector; 3]>> },
    /// A sphere, or a cylinder between two heights.
    Round { center: Vector, square_radius: RBig, ends: Option<[RBig; 2]> },
}

impl ExactOccluder {
    /// Takes the surface as `light` sees it; `None` if nobody can tell whether it passes through
    /// the light, or if a number is not finite.
    #[must_use]
    pub fn new(occluder: &Occluder, light: DVec3) -> Option<Self> {
        let light = vector(light)?;
        let surface = match *occluder {
            Occluder::Plane(Plane { point, normal, .. }) => {
                Surface::flat(vector(point)?, vector(normal)?, None, &light)?
            }
            Occluder::Triangle(Triangle { vertices: [a, b, c], .. }) => {
                let corners = [vector(a)?, vector(b)?, vector(c)?];
                let [a, b, c] = &corners;
                let normal = cross(&subtract(b, a), &subtract(c, a));
                Surface::flat(a.clone(), normal, Some(corners), &light)?
            }
            Occluder::Sphere(Sphere { center, radius, .. }) => {
                Surface::round(vector(center)?, radius, None, &light)?
            }
            Occluder::Cylinder(Cylinder { bottom, top, radius, .. }) => {
                let ends = [RBig::try_from(bottom.y).ok()?, RBig::try_from(top.y).ok()?];
                Surface::round(vector(bottom)?, radius, Some(ends), &light)?
            }
        };
        Some(Self { light, surface })
    }

    /// Returns whether the surface lies strictly between the light and a finite point.
    #[must_use]
    pub fn hides_from(&self, point: DVec3) -> Option<bool> {
        Some(self.lies_between(&vector(point)?))
    }

    fn lies_between(&self, from: &Vector) -> bool {
        let direction = subtract(&self.light, from);
        match &self.surface {
            Surface::Flat { point, normal, corners } => {
                let height = |of: &Vector| sign(&dot(&subtract(of, point), normal));
                let separated = match (height(from), height(&self.light)) {
                    (Ordering::Equal, _) | (_, Ordering::Equal) => false,
                    (start, end) => start != end,
                };
                separated
                    && corners.as_ref().is_none_or(|corners| crosses(corners, from, &direction))
            }
            Surface::Round { center, square_radius, ends } => {
                let mut from_center = subtract(from, center);
                let mut across = direction.clone();
                if ends.is_some() {
                    (from_center[1], across[1]) = (RBig::ZERO, RBig::ZERO);
                }
                let (a, h) = (dot(&across, &across), dot(&from_center, &across));
                let c = dot(&from_center, &from_center) - square_radius;
                let discriminant = &h * &h - &a * &c;
                if a.is_zero() || sign(&discriminant).is_lt() {
                    return false;
                }
                let half_chord = RBig::ONE / &a;
                [-&half_chord, half_chord].into_iter().any(|s| {
                    let t = Surd::root(s, discriminant.clone()).plus(&(-&h / &a));
                    let between = t.sign().is_gt() && t.plus(&-RBig::ONE).sign().is_lt();
                    let y = t.times(&direction[1]).plus(&from[1]);
                    between
                        && ends.as_ref().is_none_or(|[bottom, top]| {
                            y.plus(&-bottom).sign().is_ge() && y.plus(&-top).sign().is_le()
                        })
                })
            }
        }
    }
}

impl Surface {
    fn flat(
        point: Vector,
        normal: Vector,
        corners: Option<[Vector; 3]>,
        light: &Vector,
    ) -> Option<Self> {
        let height = dot(&subtract(light, &point), &normal);
        let size = |of: &Vector| dot_of_sizes(of, &normal);
        let farthest = corners.as_ref().map_or_else(
            || float(&size(&point)),
            |corners| corners.iter().map(|corner| float(&size(corner))).fold(0.0, f64::max),
        );
        if !in_surface(&height, farthest + float(&size(light)))? {
            let corners = corners.map(Box::new);
            return Some(Self::Flat { point, normal, corners });
        }
        let up = &height / &dot(&normal, &normal);
        let moved = |v: Vector| std::array::from_fn(|i| &v[i] + &up * &normal[i]);
        let corners = corners.map(|corners| Box::new(corners.map(moved)));
        Some(Self::Flat { point: light.clone(), normal, corners })
    }

    fn round(center: Vector, radius: f64, ends: Option<[RBig; 2]>, light: &Vector) -> Option<Self> {
        let radius = RBig::try_from(radius).ok()?;
        let mut outward = subtract(light, &center);
        if ends.is_some() {
            outward[1] = RBig::ZERO;
        }
        let square = sum(&products(&outward, &outward));
        let square_radius = &radius * &radius;
        let reach: Vector = std::array::from_fn(|i| abs(&light[i]) + abs(&center[i]));
        let size = float(&(dot_of_sizes(&outward, &reach) + &square_radius));
        let through = in_surface(&(&square - &square_radius), size)?;
        Some(Self::Round {
            center,
            square_radius: if through { square } else { square_radius },
            ends,
        })
    }
}

/// Returns whether a light at this distance from a surface lies in it, given the size of the terms
/// of the distance; `None` if nobody can tell.
fn in_surface(distance: &RBig, size: f64) -> Option<bool> {
    match float(distance).abs() / (size * ROUNDING) {
        near if near <= IN_SURFACE => Some(true),
        far if far >= BESIDE => Some(false),
        _ => None,
    }
}

/// Returns whether a line crosses a triangle, or touches its edge.
fn crosses(corners: &[Vector; 3], from: &Vector, direction: &Vector) -> bool {
    let [a, b, c] = corners.each_ref().map(|corner| subtract(corner, from));
    let sides = [(&a, &b), (&b, &c), (&c, &a)].map(|(p, q)| sign(&dot(direction, &cross(p, q))));
    sides.iter().all(|side| side.is_ge()) || sides.iter().all(|side| side.is_le())
}

fn vector(v: DVec3) -> Option<Vector> {
    let [x, y, z] = v.to_array().map(|number| RBig::try_from(number).ok());
    Some([x?, y?, z?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hidden(occluder: Occluder, light: DVec3, point: DVec3) -> bool {
        let exact = ExactOccluder::new(&occluder, light).expect("decidable");
        exact.hides_from(point).expect("finite")
    }

    /// Catches a surface that hides a light in it, and one that hides nothing: the pole of a ball,
    /// the middle of a tilted plane, a wall.
    #[test]
    fn only_what_lies_before_the_light_hides_it() {
        let ball = Sphere { center: DVec3::NEG_Y, radius: 1.0, material: 0 };
        let point = |y| DVec3::new(3.0, y, 0.0);
        for (y, expected) in [(1e-9, false), (0.0, false), (-1e-9, true)] {
            assert_eq!(hidden(Occluder::Sphere(ball), DVec3::ZERO, point(y)), expected, "{y}");
        }
        // 0.1 + 0.2 is not 0.3 in binary.
        let normal = DVec3::new(1.0, 1.0, -1.0);
        let plane = Occluder::Plane(Plane { point: DVec3::ZERO, normal, material: 0 });
        let corners = [(7.0, -5.0), (-7.0, -5.0), (0.0, 9.0)];
        let vertices = corners.map(|(x, y)| DVec3::new(x, y, x + y));
        let triangle = Occluder::Triangle(Triangle { vertices, material: 0 });
        for occluder in [plane, triangle] {
            let light = DVec3::new(0.1, 0.2, 0.3);
            for sign in [-1.0, 1.0] {
                assert!(!hidden(occluder, light, DVec3::ONE * sign));
                let before = light + normal * (sign * 1e-9);
                assert_eq!(hidden(occluder, before, DVec3::ONE), sign < 0.0, "{occluder:?}");
            }
        }
        let (bottom, top) = (DVec3::ZERO, DVec3::Y);
        let wall = Occluder::Cylinder(Cylinder { bottom, top, radius: 0.5, material: 0 });
        let light = DVec3::new(0.5, 0.5, 0.0);
        let seen = |x, y| !hidden(wall, light, DVec3::new(x, y, 0.0));
        assert_eq!([seen(2.0, 0.5), seen(-0.2, 0.5), seen(-2.0, 0.5)], [true, true, false]);
        // Through the open top.
        assert!(seen(-2.0, 2.5));
    }
}
