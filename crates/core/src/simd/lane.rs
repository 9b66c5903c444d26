//! The number type of the tracer: one number, or several side by side.
//!
//! Every formula is written once over [`Lane`]. For `f32` and `f64` a [`Mask`] is a `bool`,
//! `any` is a plain branch and `select` an `if`: the scalar program. For a vector of numbers the
//! same text is a packet program, and gives each lane the same bits, because every operation here
//! is one that IEEE 754 rounds correctly.
//!
//! What is missing is missing on purpose: no multiply-add (it rounds once where `*` and `+` round
//! twice), no `powf`, `exp` or `sin` (whose last bits differ between libraries).

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// One truth value a lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Whether it holds in any lane.
    fn any(self) -> bool;
    /// A bit a lane, the first lane's being the lowest.
    fn bits(self) -> u32;
}

/// One number a lane.
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
    /// One index a lane: of a primitive, or an exponent.
    type Index: Copy;
    /// How many numbers there are.
    const LANES: usize;

    /// The number of each lane.
    fn from_fn(number: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// The first `LANES` numbers of `numbers`.
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
    /// True in the first `count` lanes.
    fn first_lanes(count: usize) -> Self::Mask;

    /// The same number in every lane.
    fn splat(x: Self::Scalar) -> Self;
    /// The same index in every lane.
    fn splat_index(index: u32) -> Self::Index;

    /// Square root, correctly rounded; NaN below 0.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The smaller; `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger; `other` if either is NaN.
    fn max(self, other: Self) -> Self;

    /// Whether `self < other`; not so if either is NaN, here and in the following.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// Whether `self == other`.
    fn equals(self, other: Self) -> Self::Mask;

    /// `yes` where the mask holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `yes` where the mask holds, `no` elsewhere.
    fn select_index(mask: Self::Mask, yes: Self::Index, no: Self::Index) -> Self::Index;
    /// The three numbers in the first lane where the mask holds.
    fn first(mask: Self::Mask, numbers: [Self; 3]) -> Option<[Self::Scalar; 3]>;
    /// The index in the first lane where the mask holds.
    fn first_index(mask: Self::Mask, indices: Self::Index) -> Option<u32>;
    /// A number that, as good as certainly, only these two in this order give; of 32 bits.
    fn hash_combine(hash: Self::Index, with: Self::Index) -> Self::Index;
    /// Overwrites the first `LANES` numbers of `numbers`.
    ///
    /// # Panics
    ///
    /// If there are fewer.
    fn store_index(index: Self::Index, numbers: &mut [u32]);
    /// The lanes that hold `index`.
    fn index_equals(indices: Self::Index, index: u32) -> Self::Mask;
    /// The lanes that hold an index above `index`.
    fn index_above(indices: Self::Index, index: u32) -> Self::Mask;

    /// The number of the source text in every lane.
    #[inline(always)]
    fn literal(x: f64) -> Self {
        Self::splat(Self::Scalar::from_f64(x))
    }
}

/// A lane of one: the types in which a scene is stored.
pub trait Scalar:
    Lane<Scalar = Self, Mask = bool, Index = u32> + Default + Send + Sync + 'static
{
    /// As many as fill 256 bits.
    type Wide256: Lane<Scalar = Self>;
    /// As many as fill 512 bits.
    type Wide512: Lane<Scalar = Self>;
    /// Unit roundoff `u`: the largest relative error of one rounded operation.
    const ROUNDOFF: f64;
    /// `2^s + 1`, where `s` is half of the digits, rounded up: it splits a number into halves.
    const SPLITTER: f64;

    /// The nearest number of this type.
    fn from_f64(x: f64) -> Self;
    /// The same number.
    fn to_f64(self) -> f64;
    /// The nearest `f32`, in which pictures are kept.
    fn to_f32(self) -> f32;
}

/// An odd number near 2^32 over the golden ratio, which spreads what it multiplies (Knuth, The Art
/// of Computer Programming 3, 1973, 6.4).
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

/// `a b - c d` with its sign right (and zero only if it is zero), barring under- and overflow.
///
/// The rounded products decide unless they are equal; then their rounding errors do, which the
/// error-free product of Dekker (1971) finds with the splitting of Veltkamp (1968). It is the
/// exact decision on zero edges that the watertight test of Woop, Benthin and Wald (2013) takes
/// from wider arithmetic.
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

/// `a b - product`, exactly, for a `product` that is the rounded one.
#[inline(never)]
pub(crate) fn product_error<L: Lane>(a: L, b: L, product: L) -> L {
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    al * bl - (((product - ah * bh) - al * bh) - ah * bl)
}

/// `a + b - sum`, exactly, for a `sum` that is the rounded one (Knuth, The Art of Computer
/// Programming 2, 1969).
#[inline(always)]
pub(crate) fn sum_error<L: Lane>(a: L, b: L, sum: L) -> L {
    let b_part = sum - a;
    (a - (sum - b_part)) + (b - b_part)
}

/// The upper and the lower half of the digits of `x`.
#[inline(always)]
fn split<L: Lane>(x: L) -> (L, L) {
    let scaled = L::literal(L::Scalar::SPLITTER) * x;
    let high = scaled - (scaled - x);
    (high, x - high)
}
