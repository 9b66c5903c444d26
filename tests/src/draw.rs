//! Random numbers, and what follows from them alone.
//!
//! Functions that are not correctly rounded come from `libm`, so that a seed gives the same
//! numbers on every machine.

use glam::DVec3;
use rayweave_measure::random::SplitMix64;
use std::ops::RangeInclusive;

/// A source of random numbers, sizes and directions.
pub(crate) struct Draw {
    random: SplitMix64,
}

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self { random: SplitMix64::new(seed) }
    }

    /// A number in 0..1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.random.fraction()
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A size between two above 0, each order of magnitude as likely as the next.
    pub(crate) fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    pub(crate) fn integer(&mut self, range: RangeInclusive<u32>) -> u32 {
        range.start() + (self.random.next_u64() % u64::from(range.end() - range.start() + 1)) as u32
    }

    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// A point in a cube around the origin.
    pub(crate) fn within(&mut self, half_side: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.between(-half_side, half_side)))
    }

    /// A unit vector, each direction as likely.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.within(1.0);
            if (0.1..=1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }

    pub(crate) fn color(&mut self) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.unit()))
    }

    pub(crate) fn index(&mut self, count: usize) -> usize {
        self.integer(0..=count as u32 - 1) as usize
    }

    pub(crate) fn several<T>(
        &mut self,
        count: RangeInclusive<u32>,
        mut one: impl FnMut(&mut Self) -> T,
    ) -> Vec<T> {
        (0..self.integer(count)).map(|_| one(self)).collect()
    }

    /// Sometimes ends a list with the copy of an entry, in another material.
    pub(crate) fn copy_one<T: Copy>(
        &mut self,
        list: &mut Vec<T>,
        set_material: impl Fn(&mut T, usize),
        count: usize,
    ) {
        if !list.is_empty() && self.chance(0.15) {
            let mut copy = list[self.index(list.len())];
            set_material(&mut copy, self.index(count));
            list.push(copy);
        }
    }
}
