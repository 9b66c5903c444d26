//! The packets: as many numbers as fill a SIMD register, from the `wide` crate.
//!
//! Each operation rounds like that of a single number, so a packet gives each lane the bits of one
//! ray alone. Where the machine has no register of that width, `wide` uses several smaller ones.

use crate::simd::lane::{HASH_MULTIPLIER, Lane, Mask};
use wide::{f32x8, f32x16, f64x4, f64x8, u32x8, u32x16, u64x4, u64x8};

macro_rules! packet {
    ($packet:ident of $lanes:literal $scalar:ident, $index:ident) => {
        /// A mask whose lanes have all bits set, or none.
        impl Mask for $packet {
            #[inline(always)]
            fn any(self) -> bool {
                $packet::any(self)
            }
            #[inline(always)]
            fn bits(self) -> u32 {
                self.to_bitmask()
            }
        }

        impl Lane for $packet {
            type Scalar = $scalar;
            type Mask = Self;
            type Index = $index;
            const LANES: usize = $lanes;

            #[inline(always)]
            fn from_fn(number: impl FnMut(usize) -> $scalar) -> Self {
                Self::new(std::array::from_fn(number))
            }
            #[inline(always)]
            fn load(numbers: &[$scalar]) -> Self {
                let mut lanes = [0.0; $lanes];
                lanes.copy_from_slice(&numbers[..$lanes]);
                Self::new(lanes)
            }
            #[inline(always)]
            fn store(self, numbers: &mut [$scalar]) {
                numbers[..$lanes].copy_from_slice(&self.to_array());
            }
            #[inline(always)]
            fn first_lanes(count: usize) -> Self {
                let places = Self::new(std::array::from_fn(|i| i as $scalar));
                places.simd_lt(Self::splat(count as $scalar))
            }
            #[inline(always)]
            fn splat(x: $scalar) -> Self {
                Self::splat(x)
            }
            #[inline(always)]
            fn splat_index(index: u32) -> $index {
                $index::splat(index.into())
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $packet::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $packet::abs(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // The instruction of x86 returns `other` if either is NaN, as `Lane` asks for.
                if cfg!(target_arch = "x86_64") {
                    self.fast_min(other)
                } else {
                    self.simd_lt(other).select(self, other)
                }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if cfg!(target_arch = "x86_64") {
                    self.fast_max(other)
                } else {
                    self.simd_gt(other).select(self, other)
                }
            }
            #[inline(always)]
            fn lt(self, other: Self) -> Self {
                self.simd_lt(other)
            }
            #[inline(always)]
            fn le(self, other: Self) -> Self {
                self.simd_le(other)
            }
            #[inline(always)]
            fn equals(self, other: Self) -> Self {
                self.simd_eq(other)
            }
            #[inline(always)]
            fn select(mask: Self, yes: Self, no: Self) -> Self {
                mask.select(yes, no)
            }
            #[inline(always)]
            fn select_index(mask: Self, yes: $index, no: $index) -> $index {
                // Selected as floats: `wide` selects integers byte by byte, and AVX-512 first turns
                // the mask into one of bytes.
                mask.select(Self::from_bits(yes), Self::from_bits(no)).to_bits()
            }
            #[inline(always)]
            fn first(mask: Self, numbers: [Self; 3]) -> Option<[$scalar; 3]> {
                let lanes = mask.to_bitmask();
                let lane = lanes.trailing_zeros() as usize % $lanes;
                (lanes != 0).then(|| numbers.map(|number| number.to_array()[lane]))
            }
            #[inline(always)]
            fn first_index(mask: Self, indices: $index) -> Option<u32> {
                let lanes = mask.to_bitmask();
                // Every index came from a `u32`.
                (lanes != 0).then(|| indices.to_array()[lanes.trailing_zeros() as usize] as u32)
            }
            #[inline(always)]
            fn hash_combine(hash: $index, with: $index) -> $index {
                let low = $index::splat(u32::MAX.into());
                let rotated = ((hash << 5_u32) | (hash >> 27_u32)) & low;
                ((rotated ^ with) * $index::splat(HASH_MULTIPLIER.into())) & low
            }
            #[inline(always)]
            fn store_index(index: $index, numbers: &mut [u32]) {
                for (number, lane) in numbers[..$lanes].iter_mut().zip(index.to_array()) {
                    *number = lane as u32;
                }
            }
            #[inline(always)]
            fn index_equals(indices: $index, index: u32) -> Self {
                Self::from_bits(indices.simd_eq($index::splat(index.into())))
            }
            #[inline(always)]
            fn index_above(indices: $index, index: u32) -> Self {
                Self::from_bits(indices.simd_gt($index::splat(index.into())))
            }
        }
    };
}

packet!(f32x8 of 8 f32, u32x8);
packet!(f32x16 of 16 f32, u32x16);
packet!(f64x4 of 4 f64, u64x4);
packet!(f64x8 of 8 f64, u64x8);
