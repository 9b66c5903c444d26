//! Direction cones: for rays through one point, each primitive fills a cone of directions.
//!
//! The point is the eye, its mirror image in a plane, or a light. One dot product tells that a ray
//! is outside of a cone; only the other primitives are tried. The rays of a packet are mostly so
//! close together that one of them is tested against many cones at once, each widened by the
//! largest angle between the rays. The cones are wider than the primitives by more than the errors
//! of the formulas, so they change no image, barring underflow.

use crate::scene::{self, Scene};
use crate::shapes::MARGIN;
use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;
use glam::DVec3;

/// The cone of each primitive that is not a plane: spheres, triangles, cylinders, each in file
/// order.
#[derive(Clone, Debug)]
pub(crate) struct ConeSet<S> {
    blocks: Vec<Block<S>>,
    /// The amount added to a ray's cosine with each axis, for a unit of the ray's length. The error
    /// of a ray's end grows with its length, and matters more, the nearer a primitive is to the
    /// point.
    widening: S,
}

/// Eight cones, or fewer in the last block.
#[derive(Clone, Debug)]
struct Block<S> {
    cones: Vec<Cone<S>>,
    /// The same cones, each widened by `SPREAD` and by `SLACK`: for rays so close together that one
    /// of them stands for all. The rounding to `f32` is small beside that.
    wider: Cone<Eight>,
}

/// Eight numbers of `f32`, whatever the precision of the image is.
type Eight = <f32 as Scalar>::Wide256;

/// The directions from the point in which a primitive may be.
#[derive(Clone, Copy, Debug)]
struct Cone<L> {
    axis: Vector<L>,
    cosine: L,
}

/// The sine of the largest angle between the rays of a packet and the one that is tested for all.
const SPREAD: f64 = 1.0 / 16.0;

/// Returns the cosine of that angle.
fn spread_cosine() -> f64 {
    (1.0 - SPREAD * SPREAD).sqrt()
}

/// The largest widening by the length for which one ray stands for all. In `f32` it covers rays up
/// to 100 times as long as the closest primitive is far from the point.
const SLACK: f64 = 1.0 / 1024.0;

/// The cosine of a cone that holds all directions.
const EVERYTHING: f64 = -4.0;

impl<S: Scalar> ConeSet<S> {
    /// Makes the cones of `scene`'s primitives, seen from `point`.
    pub(crate) fn new(scene: &Scene, point: DVec3) -> Self {
        Self::around(scene, point, 0.0)
    }

    /// Makes the cones of the primitives as `mirror` shows them to `eye`. Reflected rays come
    /// straight from the eye's mirror image, up to the roundings of the hit, of the ray's start and
    /// of its direction.
    pub(crate) fn mirrored(scene: &Scene, eye: DVec3, mirror: &scene::Plane) -> Self {
        let normal = scene::unit(mirror.normal);
        let image = eye - normal * (2.0 * (eye - mirror.point).dot(normal));
        let reach = [eye, image, mirror.point].map(|point| point.abs().max_element());
        Self::around(scene, image, MARGIN * S::ROUNDOFF * reach.iter().sum::<f64>())
    }

    /// Makes the cones seen from a point that is known up to `uncertainty`.
    fn around(scene: &Scene, point: DVec3, uncertainty: f64) -> Self {
        let spheres = scene.spheres.iter().map(|s| (s.center, s.radius));
        let triangles = scene.triangles.iter().map(scene::Triangle::around);
        let cylinders = (scene.cylinders.iter())
            .map(|c| ((c.bottom + c.top) / 2.0, c.radius.hypot((c.top.y - c.bottom.y) / 2.0)));
        let around = spheres.chain(triangles).chain(cylinders);
        Self::of(around.map(|(center, radius)| (center, radius + uncertainty)), point)
    }

    /// Makes the cones around spheres, each given by its centre and its radius.
    fn of(spheres: impl Iterator<Item = (DVec3, f64)>, point: DVec3) -> Self {
        let (cones, distances): (Vec<_>, Vec<_>) =
            spheres.map(|(center, radius)| Cone::new(point, center, radius)).unzip();
        let nearest = distances.into_iter().fold(f64::INFINITY, f64::min);
        Self {
            blocks: cones.chunks(Eight::LANES).map(Block::new).collect(),
            widening: S::from_f64(2.0 * MARGIN * S::ROUNDOFF / nearest),
        }
    }

    /// Calls `found` with each primitive whose cone holds a ray of `wanted`, in order: its index
    /// among the primitives that are not planes, and these rays. `found` returns the rays that are
    /// still searching.
    ///
    /// `direction` and `length` are the rays' unit directions away from the point, and their
    /// lengths.
    #[inline(always)]
    pub(crate) fn candidates<L: Lane<Scalar = S>>(
        &self,
        (direction, length): (Vector<L>, L),
        mut wanted: L::Mask,
        mut found: impl FnMut(usize, L::Mask) -> L::Mask,
    ) {
        let Some([x, y, z]) = L::first(wanted, direction.to_array()) else { return };
        let one = Vector::new(x, y, z);
        let widening = L::splat(self.widening) * length;
        let close = L::literal(spread_cosine()).le(Vector::splat(one).dot(direction));
        let together = !(wanted & !(close & widening.le(L::literal(SLACK)))).any();
        let one_in_f32 = Vector::splat(Vector::new(x.to_f32(), y.to_f32(), z.to_f32()));
        for (number, block) in self.blocks.iter().enumerate() {
            let mut left = (1 << block.cones.len()) - 1;
            if together {
                left &= block.wider.holds(one_in_f32, Lane::literal(0.0)).bits();
            }
            while left != 0 {
                let i = left.trailing_zeros() as usize;
                left &= left - 1;
                let cone = &block.cones[i];
                let cone = Cone { axis: Vector::splat(cone.axis), cosine: L::splat(cone.cosine) };
                let inside = wanted & cone.holds(direction, widening);
                if inside.any() {
                    wanted = found(number * Eight::LANES + i, inside);
                }
            }
        }
    }
}

impl<S: Scalar> Cone<S> {
    /// Makes the cone around a sphere, and returns the sphere's distance. The distance is infinite
    /// if the cone holds all directions.
    fn new(point: DVec3, center: DVec3, radius: f64) -> (Self, f64) {
        let unit = MARGIN * S::ROUNDOFF;
        let toward = center - point;
        let distance = toward.length();
        let reach = center.abs().max_element() + point.abs().max_element() + radius;
        let sine = (radius + unit * reach) / distance;
        // The sphere is too near, or a number is NaN: all directions.
        if !(sine < 0.99 && distance.is_normal()) {
            return (Self { axis: Vector::zero(), cosine: S::from_f64(EVERYTHING) }, f64::INFINITY);
        }
        let axis = Vector::rounded(toward / distance);
        (Self { axis, cosine: S::from_f64((1.0 - sine * sine).sqrt() - unit) }, distance)
    }
}

impl<S: Scalar> Block<S> {
    fn new(cones: &[Cone<S>]) -> Self {
        let side_by_side =
            |number: fn(&Cone<S>) -> f32| Eight::from_fn(|i| cones.get(i).map_or(0.0, number));
        let x = side_by_side(|cone| cone.axis.x.to_f32());
        let y = side_by_side(|cone| cone.axis.y.to_f32());
        let z = side_by_side(|cone| cone.axis.z.to_f32());
        let cosine = side_by_side(|cone| Self::wider(cone.cosine.to_f64()) as f32);
        Self { cones: cones.to_vec(), wider: Cone { axis: Vector::new(x, y, z), cosine } }
    }

    /// Returns the cosine of a cone with this cosine after it is widened by `SPREAD` and `SLACK`.
    fn wider(cosine: f64) -> f64 {
        let cosine = cosine - SLACK;
        if cosine <= -spread_cosine() {
            return EVERYTHING;
        }
        let sum_of_angles = cosine * spread_cosine() - (1.0 - cosine * cosine).sqrt() * SPREAD;
        // The angle between such close rays is known to 13 / `SPREAD` roundings, all else to 20
        // roundings: of `f32`, at worst.
        sum_of_angles - 8.0 * MARGIN * f32::ROUNDOFF
    }
}

impl<L: Lane> Cone<L> {
    /// Returns the lanes whose unit direction is in the cone, if its cosine were less by
    /// `widening`.
    #[inline(always)]
    fn holds(&self, direction: Vector<L>, widening: L) -> L::Mask {
        // In this form, NaN rules nothing out.
        !(self.axis.dot(direction) + widening).lt(self.cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::random_points;
    use std::array::from_fn;
    use wide::{f32x8, f64x4};

    /// Catches a candidate that is left out or shown in vain: packets of neighbouring rays, some
    /// within `SPREAD` and some not, get the same candidates as if each cone were tested for each
    /// ray.
    fn no_cone_is_left_out<L: Lane>() {
        let mut point = random_points();
        let (mut together, mut shown) = (0, 0);
        for _ in 0..100_000 {
            let spheres: [_; 11] = from_fn(|_| (point() * 4.0 - 2.0, 0.1 + point().x * 0.6));
            let cones = ConeSet::<L::Scalar>::of(spheres.into_iter(), point());
            let (middle, apart) = ((point() - 0.5).normalize(), 0.05 + point().x * 0.025);
            let aside = |lane: usize| {
                if lane == 0 { DVec3::ZERO } else { (point() - 0.5).normalize() * apart }
            };
            let rays: [DVec3; 8] = from_fn(aside).map(|aside| (middle + aside).normalize());
            let of = |axis: usize| L::from_fn(|lane| Scalar::from_f64(rays[lane][axis]));
            let direction = Vector::new(of(0), of(1), of(2));
            let length = L::literal(point().x * 20.0);
            let all = L::first_lanes(L::LANES);

            let mut found = Vec::new();
            cones.candidates((direction, length), all, |i, inside| {
                found.push((i, inside.bits()));
                all
            });
            let widening = length * L::splat(cones.widening);
            let all_cones = cones.blocks.iter().flat_map(|block| &block.cones);
            let expected: Vec<(usize, u32)> = (all_cones.enumerate())
                .map(|(i, cone)| {
                    let cone =
                        Cone { axis: Vector::splat(cone.axis), cosine: L::splat(cone.cosine) };
                    (i, cone.holds(direction, widening).bits())
                })
                .filter(|&(_, inside)| inside != 0)
                .collect();
            assert_eq!(found, expected);
            together +=
                usize::from(rays[..L::LANES].iter().all(|ray| ray.dot(rays[0]) > spread_cosine()));
            shown += found.len();
        }
        // Neither no candidates nor all of them.
        assert!((25_000..75_000).contains(&together), "{together}");
        assert!((20_000..500_000).contains(&shown), "{shown}");
    }

    /// Catches a widening that is too small: a ray at the edge of a cone, widened as far as
    /// possible by the ray's length, is tested through a ray as far away as possible.
    fn the_widest_cone_holds_the_farthest_ray<L: Lane>() {
        for radius in [0.01, 0.1, 0.5, 0.9] {
            let cones = ConeSet::<L::Scalar>::of([(DVec3::Z, radius)].into_iter(), DVec3::ZERO);
            let edge = (cones.blocks[0].cones[0].cosine.to_f64() - 0.98 * SLACK).acos();
            let rays =
                [edge + 0.999 * SPREAD.asin(), edge].map(|angle| [angle.sin(), 0.0, angle.cos()]);
            let of = |axis: usize| L::from_fn(|lane| Scalar::from_f64(rays[lane.min(1)][axis]));
            let length = L::literal(0.99 * SLACK / cones.widening.to_f64());
            let mut found = Vec::new();
            cones.candidates(
                (Vector::new(of(0), of(1), of(2)), length),
                L::first_lanes(2),
                |i, inside| {
                    found.push((i, inside.bits()));
                    inside
                },
            );
            assert_eq!(found, [(0, 0b10)], "radius {radius}");
        }
    }

    #[test]
    fn no_cone_is_left_out_in_either_precision() {
        no_cone_is_left_out::<f32x8>();
        no_cone_is_left_out::<f64x4>();
    }

    #[test]
    fn the_widest_cone_holds_the_farthest_ray_in_either_precision() {
        the_widest_cone_holds_the_farthest_ray::<f32x8>();
        the_widest_cone_holds_the_farthest_ray::<f64x4>();
    }
}
