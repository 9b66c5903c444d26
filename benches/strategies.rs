//! `cargo bench`: every strategy that is available with 1, 2 and all threads, on both loads.
//!
//! A bench is called `load/strategy/threads`, so criterion's filter picks: `cargo bench corner`,
//! `cargo bench tile-queue/2`. The throughput is in pixels. Pools are built before the clock runs.
//! Criterion measures one bench after the other: to compare strategies with intervals on the
//! ratio, in interleaved rounds, run `rayweave compare`.

use criterion::{
    BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use rayweave_benches::{Load, loads};
use rayweave_contract::{Digest, Image, Plan, Threads};
use std::num::{NonZeroU32, NonZeroUsize};
use std::thread::available_parallelism;
use std::time::Duration;

/// The default of the command line.
const TILE: NonZeroU32 = NonZeroU32::new(32).expect("not 0");

fn strategies(criterion: &mut Criterion) {
    let all = available_parallelism().map_or(1, usize::from);
    let mut counts = vec![1, 2, all];
    counts.sort_unstable();
    counts.dedup();
    for load in loads() {
        let mut group = criterion.benchmark_group(load.name);
        group.throughput(Throughput::Elements(u64::from(load.width) * u64::from(load.height)));
        // A rendering takes long: each sample is one.
        group.sampling_mode(SamplingMode::Flat);
        group
            .sample_size(10)
            .warm_up_time(Duration::from_secs(1))
            .measurement_time(Duration::from_secs(5));
        let mut image = Image::new(load.width, load.height).expect("a small image");
        let mut expected = None;
        for strategy in rayweave_registry::available() {
            let alone = strategy.threads == Threads::None;
            for &threads in if alone { &[1][..] } else { &counts } {
                let plan = Plan { threads: NonZeroUsize::new(threads).expect("not 0"), tile: TILE };
                let mut renderer = strategy.prepare(plan).expect("the strategy is available");
                // A pixel that a strategy does not write is not the one of the strategy before it.
                image.fill([f32::NAN; 3]);
                let mut ran = false;
                group.bench_function(BenchmarkId::new(strategy.name, threads), |bencher| {
                    ran = true;
                    bencher.iter(|| {
                        renderer.render(&*load.work, &mut image).expect("the work does not fail");
                    });
                });
                // A timed image is checked, outside of the timing; a filter may have left it out.
                if ran {
                    let expected = *expected.get_or_insert_with(|| reference_digest(&load));
                    assert_eq!(image.digest(), expected, "{}: another image", strategy.name);
                }
            }
        }
        group.finish();
    }
}

/// The digest of the image that every strategy has to render.
fn reference_digest(load: &Load) -> Digest {
    let mut image = Image::new(load.width, load.height).expect("a small image");
    let plan = Plan { threads: NonZeroUsize::MIN, tile: TILE };
    let mut renderer = rayweave_registry::reference().prepare(plan).expect("one thread");
    renderer.render(&*load.work, &mut image).expect("the work does not fail");
    image.digest()
}

criterion_group!(benches, strategies);
criterion_main!(benches);
