//! Aims very many rays at the edges and corners of closed meshes, from inside, and counts leaks:
//! `cargo run --release -p rayweave-tests --example leaks -- --rays 100000000`.

use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use glam::DVec3;
use rayweave_core::{Caster, Precision};
use rayweave_measure::random::SplitMix64;
use rayweave_tests::meshes::{self, Mesh};
use rayweave_tests::model::Ray;
use rayweave_tests::scenes::{PRECISIONS, caster};
use rayweave_tests::transform::{enlarged, moved, rounded};

/// Rays from inside at the edges and corners of closed meshes; a ray that leaves one is a leak.
/// Exit status 1 if there is any.
#[derive(Parser)]
struct Options {
    /// The number of rays in each precision, shared evenly by the meshes
    #[arg(long, default_value_t = 10_000_000)]
    rays: u64,
    /// The seed: the same one gives the same rays, for any number of threads
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only this precision [default: one after the other]
    #[arg(long, value_parser = ["f32", "f64"])]
    precision: Option<String>,
    /// The number of threads
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: u64,
}

/// The number of places of each mesh: the first as it is, then others in another size.
const PLACES: u64 = 16;
/// The number of rays that one stream of random numbers gives.
const STREAM: u64 = 1 << 14;
/// The tolerance of `t`: on the other side of a mesh it is off by more.
const TOLERANCE: f64 = 1e-3;

/// A mesh of some size in some place.
struct Placed {
    caster: Caster,
    precision: Precision,
    triangles: Mesh,
    size: f64,
    middle: DVec3,
}

/// The number of lost rays, and the first of them.
#[derive(Default)]
struct Leaks {
    count: u64,
    first: Option<(u64, Ray)>,
}

fn main() -> io::Result<ExitCode> {
    let options = Options::parse();
    let chosen = |precision: &Precision| {
        options.precision.as_ref().is_none_or(|only| *only == precision.to_string())
    };
    let mut out = io::stdout().lock();
    let meshes = meshes::all();
    let (mut rays, mut leaks, start) = (0, 0, Instant::now());
    for precision in PRECISIONS.into_iter().filter(chosen) {
        for (number, (name, mesh)) in (0..).zip(&meshes) {
            // The first meshes take what is left over.
            let share = (options.rays + meshes.len() as u64 - 1 - number) / meshes.len() as u64;
            let mut random = stream(options.seed, number, u64::MAX);
            let placed: Vec<_> = (0..PLACES)
                .map(|place| Placed::new(mesh, precision, &mut random, place == 0))
                .collect();
            let found = lose(&placed, share, &options, number);
            writeln!(out, "{name:<12} {precision} {share:>12} rays {:>6} leaks", found.count)?;
            if let Some((ray, first)) = found.first {
                writeln!(out, "    the first is ray {ray}: {first:?}")?;
            }
            rays += share;
            leaks += found.count;
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    writeln!(out, "{:<16} {rays:>12} rays {leaks:>6} leaks in {seconds:.1} s", "total")?;
    Ok(if leaks == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Returns a stream of random numbers for each `part` of a mesh's rays.
fn stream(seed: u64, mesh: u64, part: u64) -> SplitMix64 {
    [mesh, part]
        .into_iter()
        .fold(SplitMix64::new(seed), |mut random, part| SplitMix64::new(random.next_u64() ^ part))
}

/// Sends `rays` rays through the meshes and gathers those that are lost.
fn lose(meshes: &[Placed], rays: u64, options: &Options, number: u64) -> Leaks {
    let streams = rays.div_ceil(STREAM);
    let search = |thread: u64| {
        let mut leaks = Leaks::default();
        for part in (thread..streams).step_by(options.threads as usize) {
            let mut random = stream(options.seed, number, part);
            for ray in part * STREAM..rays.min((part + 1) * STREAM) {
                leaks.look_at(ray, &meshes[random.below(meshes.len())], &mut random);
            }
        }
        leaks
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..options.threads).map(|thread| scope.spawn(move || search(thread))).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .fold(Leaks::default(), Leaks::and)
    })
}

impl Leaks {
    fn look_at(&mut self, number: u64, mesh: &Placed, random: &mut SplitMix64) {
        let ray = mesh.ray(random);
        let hit = mesh.caster.closest_hit(ray.origin, ray.direction);
        if hit.is_none_or(|hit| (hit.t - 1.0).abs() > TOLERANCE) {
            self.count += 1;
            self.first.get_or_insert((number, ray));
        }
    }

    fn and(self, other: Self) -> Self {
        let first = self.first.into_iter().chain(other.first).min_by_key(|&(number, _)| number);
        Self { count: self.count + other.count, first }
    }
}

impl Placed {
    fn new(
        mesh: &[[DVec3; 3]],
        precision: Precision,
        random: &mut SplitMix64,
        as_it_is: bool,
    ) -> Self {
        let (mut size, mut middle) = (1.0, DVec3::ZERO);
        if !as_it_is {
            size = libm::exp2(20.0 * random.fraction() - 10.0);
            middle =
                size * 70.0 * DVec3::from_array([(); 3].map(|()| 2.0 * random.fraction() - 1.0));
        }
        let scene = moved(&enlarged(&meshes::scene_of(mesh), size), middle);
        // The rays aim at exactly the corners that the kernel has.
        let scene = if precision == Precision::F32 { rounded(&scene) } else { scene };
        let triangles = scene.triangles.iter().map(|triangle| triangle.vertices).collect();
        Self { caster: caster(&scene, precision), precision, triangles, size, middle }
    }

    /// A ray from within 5/8 of the middle to a corner or a point of an edge, where `t` is 1.
    fn ray(&self, random: &mut SplitMix64) -> Ray {
        let mut coordinate = || match random.below(4) {
            0 => 0.0,
            1 => sixteenths(random) * 0.5 - 0.25,
            _ => random.fraction() * 0.7 - 0.35,
        };
        let from = DVec3::from_array([(); 3].map(|()| coordinate()));
        let origin = self.middle + self.size * from;
        let origin =
            if self.precision == Precision::F32 { origin.as_vec3().as_dvec3() } else { origin };
        let triangle = self.triangles[random.below(self.triangles.len())];
        let corner = random.below(3);
        let (a, b) = (triangle[corner], triangle[(corner + 1) % 3]);
        let share = match random.below(4) {
            0 => 0.0,
            1 => sixteenths(random),
            _ => random.fraction(),
        };
        Ray { origin, direction: (1.0 - share) * a + share * b - origin }
    }
}

/// A multiple of 1/16 in `0..=1`.
fn sixteenths(random: &mut SplitMix64) -> f64 {
    random.below(17) as f64 / 16.0
}
