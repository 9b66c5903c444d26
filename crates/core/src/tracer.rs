//! The tracer as [`Work`]: any tile of a scene's picture.

use crate::antialiasing::Filter;
use crate::camera::Camera;
use crate::formulas::{Arithmetic, Compiled, Family};
use crate::image::Tile;
use crate::lane::{Lane, Scalar};
use crate::lattice::LatticeSums;
use crate::precision::Precision;
use crate::samples::{Colors, Places};
use crate::scene::{Scene, SceneError};
use crate::trace::World;
use crate::work::Work;
use std::fmt;
use std::marker::PhantomData;

/// How a picture is computed. Only the arithmetic changes its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Execution {
    /// Formulas and number type.
    pub arithmetic: Arithmetic,
    /// Rays side by side.
    pub lanes: Lanes,
    /// Whether a lattice point that several pixels of a tile need is traced once.
    pub share_samples: bool,
}

/// How many rays are followed side by side, as a packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// As many as fill 256 bits: 8 in `f32`, 4 in `f64`.
    Wide256,
    /// As many as fill 512 bits: 16 in `f32`, 8 in `f64`.
    #[default]
    Wide512,
}

impl Lanes {
    /// Each width there is.
    pub const ALL: [Self; 3] = [Self::One, Self::Wide256, Self::Wide512];

    /// The number of rays in this precision.
    #[must_use]
    pub fn count(self, precision: Precision) -> usize {
        match (self, precision) {
            (Self::One, _) => 1,
            (Self::Wide256, Precision::F32) | (Self::Wide512, Precision::F64) => 8,
            (Self::Wide256, Precision::F64) => 4,
            (Self::Wide512, Precision::F32) => 16,
        }
    }
}

/// The fastest execution in this arithmetic: packets, and samples shared.
impl<A: Into<Arithmetic>> From<A> for Execution {
    fn from(arithmetic: A) -> Self {
        Self { arithmetic: arithmetic.into(), lanes: Lanes::default(), share_samples: true }
    }
}

/// The work of rendering `scene` into a picture of `width` x `height` pixels.
///
/// # Errors
///
/// A scene that [`Scene::check`] rejects.
pub fn tracer(
    scene: &Scene,
    width: u32,
    height: u32,
    execution: impl Into<Execution>,
) -> Result<Box<dyn Work + Send>, SceneError> {
    scene.check()?;
    let Execution { arithmetic, lanes, share_samples } = execution.into();
    Ok(arithmetic.select(Picture { scene, width, height, lanes, share_samples }))
}

/// What a tracer is compiled for.
struct Picture<'a> {
    scene: &'a Scene,
    width: u32,
    height: u32,
    lanes: Lanes,
    share_samples: bool,
}

impl Compiled for Picture<'_> {
    type Output = Box<dyn Work + Send>;

    fn compiled<S: Scalar, F: Family>(self) -> Self::Output {
        match self.lanes {
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
    lanes: PhantomData<fn(L)>,
}

impl<L: Lane, F: Family> Tracer<L, F> {
    fn new(picture: &Picture) -> Self {
        let &Picture { scene, width, height, share_samples, .. } = picture;
        let filter = Filter::new(&scene.render);
        Self {
            world: World::new(scene),
            camera: Camera::new(&scene.camera, width, filter.density()),
            filter,
            width,
            height,
            share_samples,
            lanes: PhantomData,
        }
    }

    /// The colour at each place, in packets of neighbours in the list.
    fn trace(&self, places: &mut Places<L::Scalar>, colors: &mut Colors<L::Scalar>) {
        let count = places.len();
        places.pad(L::LANES);
        colors.resize(places.len());
        for first in (0..count).step_by(L::LANES) {
            let (right, down) = places.load::<L>(first);
            let color = self.world.trace(self.camera.ray(right, down), L::first_lanes(count - first));
            colors.store(first, color);
        }
    }

    /// The centre of pixel `x` along an axis of `extent` pixels, in half steps of the filter's from the
    /// middle of the picture: a whole number below 2^23. So places on the lattice are exact in `f32`; others
    /// are rounded there, to 1/512 of a pixel in the widest picture and 1/65536 in one of 500.
    fn centre(&self, x: u32, extent: u32) -> L::Scalar {
        let half_pixels = 2 * i64::from(x) + 1 - i64::from(extent);
        Scalar::from_f64((i64::from(self.filter.density()) * half_pixels) as f64)
    }

    /// Every pixel with samples of its own.
    fn render_alone(&self, tile: &mut Tile<'_>) {
        let area = tile.area();
        let samples = self.filter.len();
        // A few packets at a time, in blocks of neighbours.
        let batch = (BATCH / samples).max(1);
        let (mut places, mut colors) = (Places::default(), Colors::default());
        let pixels: Vec<(u32, u32)> = blocks(area.width as usize, area.height as usize)
            .map(|(x, y)| (area.x + x as u32, area.y + y as u32))
            .collect();
        for pixels in pixels.chunks(batch) {
            places.clear();
            for &(x, y) in pixels {
                let (right, down) = (self.centre(x, self.width), self.centre(y, self.height));
                for (sample_right, sample_down) in self.filter.places() {
                    places.push(right + sample_right, down + sample_down);
                }
            }
            self.trace(&mut places, &mut colors);
            for (i, &(x, y)) in pixels.iter().enumerate() {
                tile.row_mut((y - area.y) as usize)[(x - area.x) as usize] = self.filter.sum(&colors, i * samples);
            }
        }
    }

    /// The lattice over the tile and around it, each point traced once.
    fn render_shared(&self, tile: &mut Tile<'_>, weights: &[L::Scalar]) {
        let area = tile.area();
        let (width, height) = (area.width as usize, area.height as usize);
        let density = self.filter.density() as usize;
        let (columns, rows) = (density * (width + 1) + 1, density * (height + 1) + 1);
        let half_steps = |i: usize| Scalar::from_f64(2.0 * (i as f64 - density as f64));
        let (left, top) = (self.centre(area.x, self.width), self.centre(area.y, self.height));
        let (mut places, mut colors) = (Places::default(), Colors::default());
        let mut sums = LatticeSums::new(weights, density, width, BLOCK);
        for first_row in (0..rows).step_by(BLOCK) {
            let strip = BLOCK.min(rows - first_row);
            places.clear();
            for (column, row) in blocks(columns, strip) {
                places.push(left + half_steps(column), top + half_steps(first_row + row));
            }
            self.trace(&mut places, &mut colors);
            sums.fill(blocks(columns, strip), &colors);
            for row in 0..strip {
                sums.add_row(row, first_row + row, tile);
            }
        }
    }
}

/// Samples that are traced together: enough to fill packets, few enough to stay in the cache.
const BATCH: usize = 1024;

/// The side of a block of neighbours: of a packet of 16.
const BLOCK: usize = 4;

/// The places of a rectangle, block by block, so that those next to each other in the list are also next to each
/// other in the picture.
fn blocks(width: usize, height: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..height).step_by(BLOCK).flat_map(move |top| {
        (0..width).step_by(BLOCK).flat_map(move |left| {
            (top..height.min(top + BLOCK)).flat_map(move |y| (left..width.min(left + BLOCK)).map(move |x| (x, y)))
        })
    })
}

impl<L: Lane, F: Family> Work for Tracer<L, F> {
    fn render(&self, tile: &mut Tile<'_>) {
        match self.filter.lattice_weights() {
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
