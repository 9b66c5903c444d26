//! Random numbers, vectors and rays, the same on every machine.

use crate::cases::Ray;
use glam::{DVec2, DVec3};
use rayweave_measure::random::SplitMix64;

/// Draws from a stream of random numbers.
pub(super) struct Draw {
    random: SplitMix64,
}

impl Draw {
    /// A stream of its own for each case: the family's name is mixed in by FNV-1a.
    pub(super) fn new(seed: u64, family: &str, index: usize) -> Self {
        let name = family.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut random = SplitMix64::new(seed);
        for part in [name, index as u64] {
            random = SplitMix64::new(random.next_u64() ^ part);
        }
        Self { random }
    }

    /// Evenly in `low..high`.
    pub(super) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.random.fraction()
    }

    /// In `low..high`, both above 0, every magnitude alike.
    pub(super) fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        libm::exp2(self.range(libm::log2(low), libm::log2(high)))
    }

    /// The same with either sign.
    pub(super) fn signed_magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.sign() * self.magnitude(low, high)
    }

    /// A whole number in `low..=high`.
    pub(super) fn integer(&mut self, low: i32, high: i32) -> i32 {
        self.range(f64::from(low), f64::from(high) + 1.0).floor() as i32
    }

    /// True in `share` of all cases.
    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.range(0.0, 1.0) < share
    }

    /// 1 or -1.
    pub(super) fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// In the cube of `-half..half`.
    pub(super) fn within(&mut self, half: f64) -> DVec3 {
        let mut coordinate = || self.range(-half, half);
        DVec3::new(coordinate(), coordinate(), coordinate())
    }

    /// With coordinates that are multiples of `step` up to `steps` of them.
    pub(super) fn lattice(&mut self, steps: i32, step: f64) -> DVec3 {
        let mut coordinate = || f64::from(self.integer(-steps, steps)) * step;
        DVec3::new(coordinate(), coordinate(), coordinate())
    }

    /// 0 in half of the cases, where f32 subtracts the centre exactly; else within the cube.
    pub(super) fn center(&mut self, half: f64) -> DVec3 {
        if self.chance(0.5) { DVec3::ZERO } else { self.within(half) }
    }

    /// A unit vector, evenly over the sphere.
    pub(super) fn unit(&mut self) -> DVec3 {
        loop {
            let vector = self.within(1.0);
            if (0.01..1.0).contains(&vector.length_squared()) {
                return vector.normalize();
            }
        }
    }

    /// A unit vector in the plane, evenly over the circle.
    pub(super) fn circle(&mut self) -> DVec2 {
        let angle = self.range(0.0, std::f64::consts::TAU);
        DVec2::new(libm::cos(angle), libm::sin(angle))
    }

    /// A unit vector at a right angle to `axis`.
    pub(super) fn across(&mut self, axis: DVec3) -> DVec3 {
        loop {
            let across = self.unit().cross(axis);
            if across.length_squared() > 0.01 * axis.length_squared() {
                return across.normalize();
            }
        }
    }

    /// In the cube of `-5..5`, 1 or more away from `target`.
    pub(super) fn away_from(&mut self, target: DVec3) -> DVec3 {
        loop {
            let point = self.within(5.0);
            if point.distance_squared(target) >= 1.0 {
                return point;
            }
        }
    }

    /// From `origin`, as f32 has it, towards `target`: in half of the cases reaching it at `t` = 1,
    /// else with a direction of unit length.
    pub(super) fn ray_to(&mut self, origin: DVec3, target: DVec3) -> Ray {
        let direction = target - rounded(origin);
        if self.chance(0.5) { ray(origin, direction) } else { ray(origin, direction.normalize()) }
    }
}

/// The ray, rounded to f32.
pub(super) fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin: single(origin), direction: single(direction) }
}

/// The coordinates, rounded to f32.
pub(super) fn single(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}

/// The vector that f32 has in place of this one.
pub(super) fn rounded(vector: DVec3) -> DVec3 {
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
