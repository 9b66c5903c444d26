//! Random numbers, vectors and rays for the families, the same on every machine.

use crate::cases::Ray;
use glam::{DVec2, DVec3};
use rayweave_measure::random::SplitMix64;

/// A stream of random numbers, with the distributions that the families need.
pub(crate) struct Draw {
    random: SplitMix64,
}

impl Draw {
    /// Creates the stream of one case; the FNV-1a hash of the family's name is part of the seed.
    pub(crate) fn new(seed: u64, family: &str, index: usize) -> Self {
        let name = family.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut random = SplitMix64::new(seed);
        for part in [name, index as u64] {
            random = SplitMix64::new(random.next_u64() ^ part);
        }
        Self { random }
    }

    /// Returns a number in `low..high`, uniformly distributed.
    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.random.fraction()
    }

    /// Returns a number in `low..high`, both above 0, with a uniformly distributed logarithm.
    pub(crate) fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        libm::exp2(self.range(libm::log2(low), libm::log2(high)))
    }

    /// Returns such a number with either sign.
    pub(crate) fn signed_magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.sign() * self.magnitude(low, high)
    }

    /// Returns an integer in `low..=high`.
    pub(crate) fn integer(&mut self, low: i32, high: i32) -> i32 {
        self.range(f64::from(low), f64::from(high) + 1.0).floor() as i32
    }

    /// Returns true in `share` of all cases.
    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.range(0.0, 1.0) < share
    }

    /// Returns 1 or -1.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// Returns a point in the cube of `-half..half`.
    pub(crate) fn within(&mut self, half: f64) -> DVec3 {
        let mut coordinate = || self.range(-half, half);
        DVec3::new(coordinate(), coordinate(), coordinate())
    }

    /// Returns a vector whose coordinates are multiples of `step`, up to `steps` of them.
    pub(crate) fn lattice(&mut self, steps: i32, step: f64) -> DVec3 {
        let mut coordinate = || f64::from(self.integer(-steps, steps)) * step;
        DVec3::new(coordinate(), coordinate(), coordinate())
    }

    /// Returns 0 in half of the cases, where f32 subtracts the centre exactly, else a point in the
    /// cube.
    pub(crate) fn center(&mut self, half: f64) -> DVec3 {
        if self.chance(0.5) { DVec3::ZERO } else { self.within(half) }
    }

    /// Returns a unit vector, uniformly distributed over the sphere.
    pub(crate) fn unit(&mut self) -> DVec3 {
        loop {
            let vector = self.within(1.0);
            if (0.01..1.0).contains(&vector.length_squared()) {
                return vector.normalize();
            }
        }
    }

    /// Returns a unit vector in the plane, uniformly distributed over the circle.
    pub(crate) fn circle(&mut self) -> DVec2 {
        let angle = self.range(0.0, std::f64::consts::TAU);
        DVec2::new(libm::cos(angle), libm::sin(angle))
    }

    /// Returns a unit vector perpendicular to `axis`.
    pub(crate) fn across(&mut self, axis: DVec3) -> DVec3 {
        loop {
            let across = self.unit().cross(axis);
            if across.length_squared() > 0.01 * axis.length_squared() {
                return across.normalize();
            }
        }
    }

    /// Returns a point in the cube of `-5..5`, at a distance of 1 or more from `target`.
    pub(crate) fn away_from(&mut self, target: DVec3) -> DVec3 {
        loop {
            let point = self.within(5.0);
            if point.distance_squared(target) >= 1.0 {
                return point;
            }
        }
    }

    /// Returns a direction that crosses a surface with the normal `outward`, inward for an even
    /// index and outward for an odd one, and the name of that side.
    pub(crate) fn through_surface(
        &mut self,
        outward: DVec3,
        index: usize,
    ) -> (DVec3, &'static str) {
        let direction = self.unit();
        let (inward, side) =
            if index.is_multiple_of(2) { (true, "inward") } else { (false, "outward") };
        let turned = (direction.dot(outward) > 0.0) == inward;
        (if turned { -direction } else { direction }, side)
    }

    /// Returns the ray from `origin`, rounded to f32, towards `target`. In half of the cases it
    /// reaches the target at `t` = 1, else its direction has unit length.
    pub(crate) fn ray_to(&mut self, origin: DVec3, target: DVec3) -> Ray {
        let direction = target - rounded(origin);
        if self.chance(0.5) { ray(origin, direction) } else { ray(origin, direction.normalize()) }
    }
}

/// Returns the ray, rounded to f32.
pub(crate) fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin: single(origin), direction: single(direction) }
}

/// Returns the coordinates, rounded to f32.
pub(crate) fn single(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}

/// Returns the vector with its coordinates rounded to f32.
pub(crate) fn rounded(vector: DVec3) -> DVec3 {
    vector.as_vec3().as_dvec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_kept_and_streams_differ() {
        let mut draw = Draw::new(7, "sphere_far", 3);
        let numbers: Vec<f64> = (0..1000).map(|_| draw.magnitude(1e-3, 1e3)).collect();
        assert!(numbers.iter().all(|number| (0.999e-3..1.001e3).contains(number)));
        let small = numbers.iter().filter(|&&number| number < 1.0).count();
        assert!((400..600).contains(&small), "{small} of 1000 below the geometric mean");
        assert!((0..1000).map(|_| draw.integer(-2, 2)).all(|number| (-2..=2).contains(&number)));
        let first = |seed, family, index| Draw::new(seed, family, index).random.next_u64();
        assert_ne!(first(7, "sphere_far", 3), first(8, "sphere_far", 3));
        assert_ne!(first(7, "sphere_far", 3), first(7, "cyl_far", 3));
        assert_ne!(first(7, "sphere_far", 3), first(7, "sphere_far", 4));
    }

    #[test]
    fn unit_vectors_have_length_one_and_a_right_angle() {
        let mut draw = Draw::new(1, "", 0);
        for _ in 0..1000 {
            let axis = draw.unit();
            let across = draw.across(axis);
            assert!((axis.length() - 1.0).abs() < 1e-15 && (across.length() - 1.0).abs() < 1e-15);
            assert!(axis.dot(across).abs() < 1e-14);
        }
    }
}
