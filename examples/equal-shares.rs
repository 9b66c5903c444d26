//! Each thread gets an equal share of the items, fixed beforehand. The shares are slices that do
//! not overlap, so no lock is needed. It belongs to lesson 2, `scoped-bands`.

use std::thread;
use std::time::Instant;

fn main() {
    let start = Instant::now();
    let mut results = vec![0; 1000];
    let (first, second) = results.split_at_mut(500);
    thread::scope(|scope| {
        for (begin, share) in [(0, first), (500, second)] {
            scope.spawn(move || {
                for (i, result) in share.iter_mut().enumerate() {
                    *result = item(begin + i);
                }
            });
        }
    });
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
