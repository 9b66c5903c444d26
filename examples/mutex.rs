//! Both threads write into one vector, which a mutex protects. An item is computed before the lock
//! is taken. It belongs to lessons 3 and 4, `mutex-image` and `mutex-rows`.

use std::sync::Mutex;
use std::thread;
use std::time::Instant;

fn main() {
    let start = Instant::now();
    let results = Mutex::new(vec![0; 1000]);
    thread::scope(|scope| {
        for share in [0..500, 500..1000] {
            scope.spawn(|| {
                for i in share {
                    let result = item(i);
                    results.lock().unwrap()[i] = result;
                }
            });
        }
    });
    print(start, &results.into_inner().unwrap());
}

/// Returns the result of item `i`. The larger `i` is, the longer it takes: up to a millisecond.
fn item(i: usize) -> u64 {
    (0..1000 * i as u64).fold(1, |x: u64, step| x.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ step)
}

fn print(start: Instant, results: &[u64]) {
    let checksum = results.iter().fold(0, |sum: u64, result| sum.rotate_left(1) ^ result);
    println!("{:.3} s, checksum {checksum:016x}", start.elapsed().as_secs_f64());
}
