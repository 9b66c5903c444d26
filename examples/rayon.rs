//! Rayon's parallel iterator halves the range of items until there are about twice as many parts as
//! threads. A stolen part is halved again; a part that nobody steals is not. Rayon has a thread for
//! each core. It belongs to lesson 8, `rayon-pixels`.

use rayon::prelude::*;
use std::time::Instant;

fn main() {
    let start = Instant::now();
    let mut results = vec![0; 1000];
    results.par_iter_mut().enumerate().for_each(|(i, result)| *result = item(i));
    print(start, &results);
}

/// Returns the result of item `i`. The larger `i` is, the longer it takes: up to a millisecond.
fn item(i: usize) -> u64 {
    (0..1000 * i as u64).fold(1, |x: u64, step| x.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ step)
}

fn print(start: Instant, results: &[u64]) {
    let checksum = results.iter().fold(0, |sum: u64, result| sum.rotate_left(1) ^ result);
    println!("{:.3} s, checksum {checksum:016x}", start.elapsed().as_secs_f64());
}
