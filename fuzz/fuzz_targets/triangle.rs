//! A ray and a triangle of any `f32` numbers, NaN, infinities and subnormals among them.
//!
//! Must hold: no panic; a miss where a number is not finite, or where a scene would find no rect;
//! in f64 the right verdict on every decidable case and the `t` that its condition number allows,
//! unless no digit of `t` is certain; in f32 the same, for differences of positions of 0 or 2^-20
//! to 2^27, and directions of which no component but 0 is below 2^-20 of the longest. Where a
//! vertex is far along one axis and near along another, decidable takes more of a margin. The exact
//! terms: `rayweave_accuracy::guarantees`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rayweave_fuzz::check(rayweave_fuzz::triangle, bytes));
