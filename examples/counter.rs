//! A free thread takes the next item: an atomic counter says which one it is. It belongs to
//! lesson 6, `row-counter`.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

fn main() {
    let start = Instant::now();
    let results: Vec<AtomicU64> = (0..1000).map(|_| AtomicU64::new(0)).collect();
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    let Some(result) = results.get(i) else { break };
                    result.store(item(i), Ordering::Relaxed);
                }
            });
        }
    });
    let results: Vec<u64> = results.into_iter().map(AtomicU64::into_inner).collect();
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
