//! A ray and a sphere of any `f32` numbers, NaN, infinities and subnormals among them.
//!
//! Must hold: no panic; a miss where a number is not finite; in f64 the right verdict on every
//! decidable case and the `t` that its condition number allows, unless no digit of `t` is certain;
//! in f32 the same, for a radius and differences of positions of 0 or 2^-20 to 2^27, and directions
//! of which no component but 0 is below 2^-20 of the longest. The exact terms:
//! `rayweave_accuracy::guarantees`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rayweave_fuzz::check(rayweave_fuzz::sphere, bytes));
