//! The number type of the tracer: one number, or several side by side.
//!
//! Every formula is written once over [`Lane`]. For `f32` and `f64` a [`Mask`] is a `bool`, `any`
//! is a plain branch and `select` an `if`: the formula is a scalar program. For a vector of numbers
//! the same text is a packet program. It gives each lane the same bits, because IEEE 754 rounds
//! every operation here correctly.
//!
//! Some operations are missing on purpose: multiply-add, which rounds once where `*` and `+` round
//! twice, and `powf`, `exp` and `sin`, whose last bits differ between libraries.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// One truth value for each lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Returns whether it is true in any lane.
    fn any(self) -> bool;
    /// Returns one bit for each lane, the first lane in the lowest bit.
    fn bits(self) -> u32;
}

/// One number for each lane.
pub trait Lane:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The type of one lane.
    type Scalar: Scalar;
    /// The result of a comparison.
    type Mask: Mask;
    /// One index for each lane: a primitive's number, an exponent or a hash.
    type Index: Copy;
    /// The number of lanes.
    const LANES: usize;

    /// Calls `number` for each lane.
    fn from_fn(number: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// Loads the first `LANES` numbers of `numbers`.
    ///
    /// # Panics
    ///
    /// If there are fewer.
    fn load(numbers: &[Self::Scalar]) -> Self;
    /// Overwrites the first `LANES` numbers of `numbers`.
    ///
    /// # Panics
    ///
    /// If there are fewer.
    fn store(self, numbers: &mut [Self::Scalar]);
    /// Returns a mask that is true in the first `count` lanes.
    fn first_lanes(count: usize) -> Self::Mask;

    /// Returns the same number in every lane.
    fn splat(x: Self::Scalar) -> Self;
    /// Returns the same index in every lane.
    fn splat_index(index: u32) -> Self::Index;

    /// Returns the square root, correctly rounded; NaN below 0.
    fn sqrt(self) -> Self;
    /// Returns the magnitude.
    fn abs(self) -> Self;
    /// Returns the smaller number; `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns the larger number; `other` if either is NaN.
    fn max(self, other: Self) -> Self;

    /// Returns `self < other`: false if either is NaN, as in the other comparisons.
    fn lt(self, other: Self) -> Self::Mask;
    /// Returns `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// Returns `self == other`.
    fn equals(self, other: Self) -> Self::Mask;

    /// Returns `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Returns `yes` where the mask is true, `no` elsewhere.
    fn select_index(mask: Self::Mask, yes: Self::Index, no: Self::Index) -> Self::Index;
    /// Returns the three numbers in the first lane where the mask is true.
    fn first(mask: Self::Mask, numbers: [Self; 3]) -> Option<[Self::Scalar; 3]>;
    /// Returns the index in the first lane where the mask is true.
    fn first_index(mask: Self::Mask, indices: Self::Index) -> Option<u32>;
    /// Returns a hash of 32 bits of a hash and a further number. The order of calls matters.
    fn hash_combine(hash: Self::Index, with: Self::Index) -> Self::Index;
    /// Overwrites the first `LANES` numbers of `numbers`.
    ///
    /// # Panics
    ///
    /// If there are fewer.
    fn store_index(index: Self::Index, numbers: &mut [u32]);
    /// Returns the lanes that hold `index`.
    fn index_equals(indices: Self::Index, index: u32) -> Self::Mask;
    /// Returns the lanes that hold an index above `index`.
    fn index_above(indices: Self::Index, index: u32) -> Self::Mask;

    /// Returns the number of the source text in every lane.
    #[inline(always)]
    fn literal(x: f64) -> Self {
        Self::splat(Self::Scalar::from_f64(x))
    }
}

/// A single number: the types in which a scene is stored.
pub trait Scalar:
    Lane<Scalar = Self, Mask = bool, Index = u32> + Default + Send + Sync + 'static
{
    /// The packet of as many numbers as fill 256 bits.
    type Wide256: Lane<Scalar = Self>;
    /// The packet of as many numbers as fill 512 bits.
    type Wide512: Lane<Scalar = Self>;
    /// The unit roundoff `u`: the largest relative error of one rounded operation.
    const ROUNDOFF: f64;
    /// The factor `2^s + 1` that splits a number into halves, where `s` is half of the digits,
    /// rounded up.
    const SPLITTER: f64;

    /// Returns the nearest number of this type.
    fn from_f64(x: f64) -> Self;
    /// Returns the same number.
    fn to_f64(self) -> f64;
    /// Returns the nearest `f32`, in which images are stored.
    fn to_f32(self) -> f32;
}

/// An odd number near 2^32 over the golden ratio. Multiplication by it spreads close numbers far
/// apart (Knuth, The Art of Computer Programming 3, 1973, 6.4).
pub(crate) const HASH_MULTIPLIER: u32 = 0x9e37_79b1;

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.into()
    }
}

macro_rules! scalar {
    ($float:ident, $wide256:ident, $wide512:ident, splitter $splitter:literal) => {
        impl Lane for $float {
            type Scalar = Self;
            type Mask = bool;
            type Index = u32;
            const LANES: usize = 1;

            #[inline(always)]
            fn from_fn(mut number: impl FnMut(usize) -> Self) -> Self {
                number(0)
            }
            #[inline(always)]
            fn load(numbers: &[Self]) -> Self {
                numbers[0]
            }
            #[inline(always)]
            fn store(self, numbers: &mut [Self]) {
                numbers[0] = self;
            }
            #[inline(always)]
            fn first_lanes(count: usize) -> bool {
                count > 0
            }
            #[inline(always)]
            fn splat(x: Self) -> Self {
                x
            }
            #[inline(always)]
            fn splat_index(index: u32) -> u32 {
                index
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $float::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn equals(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn select_index(mask: bool, yes: u32, no: u32) -> u32 {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn first(mask: bool, numbers: [Self; 3]) -> Option<[Self; 3]> {
                mask.then_some(numbers)
            }
            #[inline(always)]
            fn first_index(mask: bool, index: u32) -> Option<u32> {
                mask.then_some(index)
            }
            #[inline(always)]
            fn hash_combine(hash: u32, with: u32) -> u32 {
                (hash.rotate_left(5) ^ with).wrapping_mul(HASH_MULTIPLIER)
            }
            #[inline(always)]
            fn store_index(index: u32, numbers: &mut [u32]) {
                numbers[0] = index;
            }
            #[inline(always)]
            fn index_equals(a: u32, b: u32) -> bool {
                a == b
            }
            #[inline(always)]
            fn index_above(a: u32, b: u32) -> bool {
                a > b
            }
        }

        impl Scalar for $float {
            type Wide256 = wide::$wide256;
            type Wide512 = wide::$wide512;
            const ROUNDOFF: f64 = $float::EPSILON as f64 / 2.0;
            const SPLITTER: f64 = $splitter;

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $float
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self as f32
            }
        }
    };
}

scalar!(f32, f32x8, f32x16, splitter 4097.0);
scalar!(f64, f64x4, f64x8, splitter 134217729.0);

/// Returns a number with the sign of `a b - c d`, and zero only if that is zero, barring under- and
/// overflow.
///
/// The rounded products decide unless they are equal. Then their rounding errors decide, found by
/// the error-free product of Dekker (1971) with the splitting of Veltkamp (1968). The watertight
/// test of Woop, Benthin and Wald (2013) takes this decision on zero edges in wider arithmetic.
#[inline(always)]
pub(crate) fn sign_of_difference<L: Lane>(a: L, b: L, c: L, d: L) -> L {
    let (ab, cd) = (a * b, c * d);
    let rounded = ab - cd;
    let equal = ab.equals(cd);
    if !equal.any() {
        return rounded;
    }
    L::select(equal, product_error(a, b, ab) - product_error(c, d, cd), rounded)
}

/// Returns `a b - product` exactly, where `product` is the rounded product.
#[inline(never)]
pub(crate) fn product_error<L: Lane>(a: L, b: L, product: L) -> L {
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    al * bl - (((product - ah * bh) - al * bh) - ah * bl)
}

/// Returns `a + b - sum` exactly, where `sum` is the rounded sum (Knuth, The Art of Computer
/// Programming 2, 1969).
#[inline(always)]
pub(crate) fn sum_error<L: Lane>(a: L, b: L, sum: L) -> L {
    let b_part = sum - a;
    (a - (sum - b_part)) + (b - b_part)
}

/// Returns the upper and the lower half of the digits of `x`.
#[inline(always)]
fn split<L: Lane>(x: L) -> (L, L) {
    let scaled = L::literal(L::Scalar::SPLITTER) * x;
    let high = scaled - (scaled - x);
    (high, x - high)
}
