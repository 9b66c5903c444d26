//! One thread computes all items, one after the other. This is the loop that the other examples
//! spread over two threads. It belongs to lesson 1, `sequential`.

use std::time::Instant;

fn main() {
    let start = Instant::now();
    let mut results = vec![0; 1000];
    for (i, result) in results.iter_mut().enumerate() {
        *result = item(i);
    }
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
