//! The tracer as [`Work`]: fills any tile of a scene's image.

use crate::camera::Camera;
use crate::execution::{Execution, Lanes};
use crate::formulas::{Compiled, Family, select};
use crate::render::adaptive::Bands;
use crate::render::filter::Filter;
use crate::render::lattice::LatticeSums;
use crate::render::sample_count::lattice_points;
use crate::render::samples::{Colors, SamplePositions, lattice_distance};
use crate::scene::{Scene, SceneError};
use crate::simd::lane::{Lane, Scalar};
use crate::trace::World;
use rayweave_contract::{Rect, Tile, Work};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

/// Returns the work of rendering `scene` into an image of `width` x `height` pixels.
///
/// Either side may have up to 65,535 pixels, the limit of a scene file; in larger images the
/// positions of samples are not exact.
///
/// # Errors
///
/// A scene that [`Scene::check`] rejects.
pub fn tracer(
    scene: &Scene,
    width: u32,
    height: u32,
    execution: Execution,
) -> Result<Box<dyn Work + Send>, SceneError> {
    scene.check()?;
    Ok(TracerArguments { scene, width, height, execution }.tracer())
}

/// The arguments of a tracer, for which it is compiled in several arithmetics.
struct TracerArguments<'a> {
    scene: &'a Scene,
    width: u32,
    height: u32,
    execution: Execution,
}

impl TracerArguments<'_> {
    /// Makes the tracer. It is not generic, so that the kernels are compiled in this crate and not
    /// again in each crate that uses it.
    fn tracer(self) -> Box<dyn Work + Send> {
        select(self.scene.render.arithmetic, self)
    }
}

impl Compiled for TracerArguments<'_> {
    type Output = Box<dyn Work + Send>;

    fn compiled<S: Scalar, F: Family>(self) -> Self::Output {
        match self.execution.lanes {
            Lanes::One => Box::new(Tracer::<S, F>::new(&self)),
            Lanes::Wide256 => Box::new(Tracer::<S::Wide256, F>::new(&self)),
            Lanes::Wide512 => Box::new(Tracer::<S::Wide512, F>::new(&self)),
        }
    }
}

/// A scene ready to be rendered at one size, in packets of `L`.
struct Tracer<L: Lane, F> {
    world: World<L::Scalar, F>,
    camera: Camera<L::Scalar>,
    filter: Filter<L::Scalar>,
    width: u32,
    height: u32,
    share_samples: bool,
    adaptive: bool,
    lanes: PhantomData<fn(L)>,
}

impl<L: Lane, F: Family> Tracer<L, F> {
    fn new(arguments: &TracerArguments) -> Self {
        let &TracerArguments { scene, width, height, execution } = arguments;
        let filter = Filter::new(&scene.render);
        Self {
            world: World::new(scene, Some(scene.camera.position), execution.acceleration),
            camera: Camera::new(&scene.camera, width, filter.density()),
            filter,
            width,
            height,
            share_samples: execution.share_samples,
            adaptive: scene.render.adaptive,
            lanes: PhantomData,
        }
    }

    /// Traces the rays through these positions, relative to `(x, y)`. Neighbours in the list share
    /// packets.
    fn trace(
        &self,
        positions: &SamplePositions<L::Scalar>,
        (x, y): (L::Scalar, L::Scalar),
        colors: &mut Colors<L::Scalar>,
    ) {
        colors.resize(positions.len().next_multiple_of(L::LANES), self.adaptive);
        for first in (0..positions.len()).step_by(L::LANES) {
            #[cfg(test)]
            tests::PACKETS.set(tests::PACKETS.get() + 1);
            let (dx, dy) = positions.load::<L>(first);
            let ray = self.camera.ray(L::splat(x) + dx, L::splat(y) + dy);
            colors
                .store(first, self.world.trace(ray, L::first_lanes(positions.len() - first), true));
        }
    }

    /// Returns the centre of pixel `x` along an axis of `extent` pixels, in half lattice steps from
    /// the middle of the image.
    ///
    /// It is a whole number below 2^23, so positions on the lattice are exact in `f32`. Other
    /// positions are rounded there, to 1/512 of a pixel in the widest image and to 1/65536 of a
    /// pixel in an image of 500 pixels.
    fn centre(&self, x: u32, extent: u32) -> L::Scalar {
        let half_pixels = 2 * i64::from(x) + 1 - i64::from(extent);
        Scalar::from_f64((i64::from(self.filter.density()) * half_pixels) as f64)
    }

    /// Returns the position of the first lattice point of a tile, one pixel before the centre of
    /// the tile's first pixel.
    fn corner(&self, rect: Rect) -> (L::Scalar, L::Scalar) {
        let back = lattice_distance(-i64::from(self.filter.density()));
        (self.centre(rect.x, self.width) + back, self.centre(rect.y, self.height) + back)
    }

    /// Renders every pixel with samples of its own.
    fn render_alone(&self, tile: &mut Tile<'_>) {
        let rect = tile.rect();
        let xs: Vec<L::Scalar> =
            (0..rect.width).map(|x| self.centre(rect.x + x, self.width)).collect();
        let ys: Vec<L::Scalar> =
            (0..rect.height).map(|y| self.centre(rect.y + y, self.height)).collect();
        let samples = self.filter.positions();
        let (side, runs_a_batch) = block(samples.len());
        let (mut runs, mut positions, mut colors) =
            (Vec::new(), SamplePositions::default(), Colors::default());
        for top in (0..ys.len()).step_by(side) {
            // The strips of a narrow tile do not fill their packets. Combining several strips would
            // cost all other tiles more.
            runs.clear();
            let strip = top..ys.len().min(top + side);
            for_each_run(xs.len(), strip, side, |columns, row| runs.push((columns, row)));
            for batch in runs.chunks(runs_a_batch) {
                positions.clear();
                for (columns, row) in batch {
                    positions.push_around(&xs[columns.clone()], ys[*row], samples);
                }
                let zero = L::Scalar::literal(0.0);
                self.trace(&positions, (zero, zero), &mut colors);
                let mut first = 0;
                for (columns, row) in batch {
                    self.filter.sums(&colors, first, &mut tile.row_mut(*row)[columns.clone()]);
                    first += columns.len() * samples.len();
                }
            }
        }
    }

    /// Traces each point of the lattice over the tile and around it once.
    fn render_shared(&self, tile: &mut Tile<'_>, weights: &[L::Scalar]) {
        let (rect, density) = (tile.rect(), self.filter.density());
        let [columns, rows] =
            [rect.width, rect.height].map(|pixels| lattice_points(pixels, density) as usize);
        let (left, top) = self.corner(rect);
        let (mut positions, mut colors) = (SamplePositions::default(), Colors::default());
        let mut sums = LatticeSums::new(weights, density as usize, rect.width as usize);
        let mut height = 0;
        for first_row in (0..rows).step_by(BLOCK) {
            // All strips of a tile have the same positions, except the last one, which may be
            // lower.
            let strip = BLOCK.min(rows - first_row);
            if strip != height {
                height = strip;
                positions.clear();
                sums.start_strip(strip);
                for_each_run(columns, 0..strip, BLOCK, |run, row| {
                    for column in run {
                        positions
                            .push(lattice_distance(column as i64), lattice_distance(row as i64));
                        sums.expect(column, row);
                    }
                });
            }
            self.trace(&positions, (left, top + lattice_distance(first_row as i64)), &mut colors);
            sums.fill(&colors);
            for row in first_row..first_row + strip {
                sums.add_row(row - first_row, row, tile);
            }
        }
    }

    /// Traces the points of the lattice over the tile and around it where the image changes, and
    /// interpolates the others.
    fn render_adaptive(&self, tile: &mut Tile<'_>, weights: &[L::Scalar]) {
        let (rect, density) = (tile.rect(), self.filter.density());
        let (left, top) = self.corner(rect);
        let (mut positions, mut colors) = (SamplePositions::default(), Colors::default());
        let mut sums = LatticeSums::new(weights, density as usize, rect.width as usize);
        let mut bands = Bands::new(density as usize, rect.width as usize);
        for centres in 0..rect.height + 2 {
            // The band ends at lattice row `last`. The first band is only this row.
            let last = i64::from(centres * density);
            bands.centre_positions(&mut positions);
            self.trace(&positions, (left, top + lattice_distance(last)), &mut colors);
            bands.take_centres(&colors);
            bands.interpolate(&mut sums, &mut positions);
            let first = last + 1 - i64::from(density);
            self.trace(&positions, (left, top + lattice_distance(first)), &mut colors);
            sums.fill(&colors);
            for row in first.max(0)..=last {
                sums.add_row((row - first) as usize, row as usize, tile);
            }
        }
    }
}

/// The number of samples that are traced together: enough to fill packets, few enough to stay in
/// the cache.
const BATCH: usize = 1024;

/// The largest side of a block of neighbours: 4 x 4 pixels fill a packet of 16.
pub(crate) const BLOCK: usize = 4;

/// Returns the side of a block of pixels with `samples` samples each, and the number of its rows in
/// a batch.
pub(crate) fn block(samples: usize) -> (usize, usize) {
    // The widest block such that a row of it fits into a batch; one pixel if no block does.
    let side = (BATCH / samples).clamp(1, BLOCK);
    (side, (BATCH / (side * samples)).max(1))
}

/// Calls `show` with the columns and the row of each row of each block of a strip. The blocks are
/// `side` columns wide and follow each other, so that consecutive samples are neighbours.
#[inline(always)]
pub(crate) fn for_each_run(
    width: usize,
    strip: Range<usize>,
    side: usize,
    mut show: impl FnMut(Range<usize>, usize),
) {
    for left in (0..width).step_by(side) {
        for row in strip.clone() {
            show(left..width.min(left + side), row);
        }
    }
}

impl<L: Lane, F: Family> Work for Tracer<L, F> {
    fn render(&self, tile: &mut Tile<'_>) {
        match self.filter.lattice_weights() {
            Some(weights) if self.adaptive => self.render_adaptive(tile, weights),
            Some(weights) if self.share_samples => self.render_shared(tile, weights),
            _ => self.render_alone(tile),
        }
    }
}

impl<L: Lane, F> fmt::Debug for Tracer<L, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Tracer({} x {})", self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::sample_count::{primary_packets, primary_rays};
    use crate::scene::{Camera, RenderSettings};
    use crate::settings::{Precision, Sampling};
    use glam::DVec3;
    use rayweave_contract::Image;
    use std::cell::Cell;
    use std::num::NonZeroU32;

    thread_local! {
        /// The number of packets that this thread has traced.
        pub(super) static PACKETS: Cell<u64> = const { Cell::new(0) };
    }

    /// Returns a scene without primitives.
    fn empty() -> Scene {
        let camera = Camera {
            position: DVec3::ZERO,
            look_at: DVec3::Z,
            up: DVec3::Y,
            focal_length: 1.0,
            screen_width: 1.0,
        };
        Scene {
            camera,
            render: RenderSettings::default(),
            lights: Vec::new(),
            materials: Vec::new(),
            planes: Vec::new(),
            spheres: Vec::new(),
            triangles: Vec::new(),
            cylinders: Vec::new(),
        }
    }

    fn settings() -> Vec<RenderSettings> {
        let samples = [
            (0, Sampling::Lattice),
            (1, Sampling::Lattice),
            (2, Sampling::Lattice),
            (6, Sampling::Lattice),
            (9, Sampling::Lattice),
            (2, Sampling::Importance),
        ];
        let settings = |(antialiasing, sampling), precision: Precision| {
            let arithmetic = precision.into();
            RenderSettings { antialiasing, sampling, arithmetic, ..RenderSettings::default() }
        };
        let precisions = [Precision::F32, Precision::F64];
        samples
            .iter()
            .flat_map(|&way| precisions.map(|precision| settings(way, precision)))
            .collect()
    }

    /// Catches a count that does not follow the strips and batches of the tracer.
    #[test]
    fn packets_are_counted_as_they_are_traced() {
        for render in settings() {
            let scene = Scene { render, ..empty() };
            for lanes in Lanes::ALL {
                for share_samples in [false, true] {
                    let execution = Execution { lanes, share_samples, ..Execution::default() };
                    for (width, height) in [(1, 1), (7, 1), (1, 9), (8, 4), (13, 11)] {
                        let work = tracer(&scene, width, height, execution).expect("a scene");
                        let mut image = Image::new(width, height).expect("an image");
                        let before = PACKETS.get();
                        let whole = NonZeroU32::new(13).expect("not 0");
                        image.tiles(whole).iter_mut().for_each(|tile| work.render(tile));
                        let traced = PACKETS.get() - before;
                        let counted = primary_packets(width, height, &scene.render, execution);
                        let what = format!("{width} x {height}, {execution:?}, {:?}", scene.render);
                        assert_eq!(counted, Some(traced), "{what}");
                        let rays = primary_rays(width, height, &scene.render, share_samples);
                        let lanes = lanes.count(scene.render.arithmetic.precision) as u64;
                        assert!(rays <= Some(traced * lanes) && traced > 0, "{what}");
                    }
                }
            }
        }
    }
}
