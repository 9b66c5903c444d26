//! `cargo bench --bench kernels`: the cost of a ray, on one thread.
//!
//! A bench is called `scene/formulas/precision/lanes`, so criterion's filter picks: `cargo bench
//! --bench kernels -- spheres/robust/f32`. The throughput is in rays, in `filter` in pixels; its
//! inverse is the time of one. The groups are:
//!
//! | group | rays | a ray tries |
//! |---|---|---|
//! | `empty scene` | from the eye | nothing: the least a ray costs |
//! | `planes`, `spheres`, `triangles`, `cylinders` | from the eye | each of 8 of the kind |
//! | `shadows of spheres`, ... | these, and from each hit to a light | each of the 8 |
//! | `BVH of N spheres` | from the eye | the candidates of the BVH |
//! | `BVH of N mirrors` | these, and from each hit one in its own direction | the same |
//! | `filter` | of the scene `room.toml`, by kind of anti-aliasing | the candidates |
//!
//! A ray's time includes the shading of its hit. Criterion measures one bench after the other, and
//! the machine's clock and its other processes change meanwhile: for counts that repeat see
//! `scripts/instructions`.

use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group,
    criterion_main,
};
use rayweave_benches::{Kind, Probe, Rays, scene};
use rayweave_core::scene::RenderSettings;
use rayweave_core::{
    Acceleration, Arithmetic, Execution, Formulas, Lanes, Precision, Sampling, Scene,
};
use std::time::Duration;

fn kinds(criterion: &mut Criterion) {
    let both = [Formulas::Robust, Formulas::Textbook];
    bench_rays(criterion, "empty scene", &Probe::empty(), Rays::FromEye, &both, Acceleration::None);
    for kind in Kind::ALL {
        let probe = Probe::of(kind, Rays::FromEye);
        bench_rays(criterion, kind.name(), &probe, Rays::FromEye, &both, Acceleration::None);
    }
}

fn shadows(criterion: &mut Criterion) {
    // Planes have no bench: they hide no light from a point on the eye's side of them, and no ray
    // tries them.
    for kind in [Kind::Spheres, Kind::Triangles, Kind::Cylinders] {
        let name = format!("shadows of {}", kind.name());
        let probe = Probe::of(kind, Rays::AndShadows);
        bench_rays(
            criterion,
            &name,
            &probe,
            Rays::AndShadows,
            &[Formulas::Robust],
            Acceleration::None,
        );
    }
}

fn bvhs(criterion: &mut Criterion) {
    for (rays, what) in [(Rays::FromEye, "spheres"), (Rays::AndMirrored, "mirrors")] {
        for count in [1_000, 100_000] {
            let name = format!("BVH of {count} {what}");
            bench_rays(
                criterion,
                &name,
                &Probe::cloud(count, rays),
                rays,
                &[Formulas::Robust],
                Acceleration::Auto,
            );
        }
    }
}

fn bench_rays(
    criterion: &mut Criterion,
    name: &str,
    probe: &Probe,
    rays: Rays,
    formulas: &[Formulas],
    acceleration: Acceleration,
) {
    let mut group = group(criterion, name);
    let count = if rays == Rays::FromEye { probe.pixels() } else { probe.pixels() + probe.hits() };
    group.throughput(Throughput::Elements(count));
    for &formulas in formulas {
        for precision in [Precision::F32, Precision::F64] {
            let arithmetic = Arithmetic { formulas, precision };
            let execution = Execution { acceleration, ..Execution::default() };
            bench_lanes(
                &mut group,
                &format!("{formulas}/{precision}"),
                probe,
                (arithmetic, execution),
            );
        }
    }
    group.finish();
}

fn filter(criterion: &mut Criterion) {
    let mut group = group(criterion, "filter");
    let room = scene("room.toml");
    let lattice = RenderSettings { antialiasing: 2, sampling: Sampling::Lattice, ..room.render };
    let one = RenderSettings { antialiasing: 0, ..lattice };
    let adaptive = RenderSettings { adaptive: true, ..lattice };
    let importance = RenderSettings { sampling: Sampling::Importance, ..lattice };
    for (name, render, share_samples) in [
        ("1 sample a pixel", one, true),
        ("25 samples a pixel, shared", lattice, true),
        ("25 samples a pixel, each its own", lattice, false),
        ("25 samples a pixel, adaptive", adaptive, true),
        ("13 samples a pixel, by importance", importance, true),
    ] {
        let scene = Scene { render, ..room.clone() };
        let probe = Probe::whole(scene, 64, 32);
        group.throughput(Throughput::Elements(probe.pixels()));
        let execution = Execution { share_samples, ..Execution::default() };
        bench_lanes(&mut group, name, &probe, (Precision::F32.into(), execution));
    }
    group.finish();
}

/// Opens a group of short benches: there are many, and one rendering takes milliseconds at most.
fn group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.sampling_mode(SamplingMode::Flat).sample_size(10).nresamples(2000);
    group.warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_millis(600));
    group
}

/// Adds one bench for each number of lanes.
fn bench_lanes(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    probe: &Probe,
    (arithmetic, execution): (Arithmetic, Execution),
) {
    let mut expected = None;
    for lanes in Lanes::ALL {
        let count = lanes.count(arithmetic.precision);
        let lanes_name = format!("{count} {}", if count == 1 { "lane" } else { "lanes" });
        let mut image = probe.image();
        let mut tiles = probe.tiles(&mut image);
        // Made when it is needed first: a filter may have left the bench out.
        let mut work = None;
        group.bench_function(BenchmarkId::new(name, lanes_name), |bencher| {
            let work = work
                .get_or_insert_with(|| probe.work(arithmetic, Execution { lanes, ..execution }));
            bencher.iter(|| tiles.iter_mut().for_each(|tile| work.render(tile)));
        });
        // The timed image is checked, outside of the timing: the lanes may not change a bit of it.
        if work.is_some() {
            let digest = image.digest();
            assert_eq!(digest, *expected.get_or_insert(digest), "{name}: another image");
        }
    }
}

criterion_group!(benches, kinds, shadows, bvhs, filter);
criterion_main!(benches);
