//! Both threads send their results through a channel to the one thread that owns the vector, so
//! nothing is shared but a counter. It belongs to lesson 5, `channel-rows`.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

fn main() {
    let start = Instant::now();
    let mut results = vec![0; 1000];
    let next = AtomicUsize::new(0);
    let next_item = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&i| i < 1000);
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for sender in [sender.clone(), sender] {
            scope.spawn(move || {
                while let Some(i) = next_item() {
                    sender.send((i, item(i))).unwrap();
                }
            });
        }
        // Ends when both senders are dropped.
        for (i, result) in receiver {
            results[i] = result;
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
