//! Images that no strategy computed, and their differences.

use rayweave_accuracy::metrics;
use rayweave_contract::{Image, Rgb, Tile, Work};
use rayweave_core::{Acceleration, Arithmetic, Execution, Lanes, Scene, tracer};
use std::num::NonZeroU32;

/// The plain execution: each ray alone, and against each primitive.
#[must_use]
pub fn plain() -> Execution {
    let (lanes, acceleration) = (Lanes::One, Acceleration::None);
    Execution { lanes, share_samples: false, acceleration }
}

/// Lists every execution; the first is the plain one.
#[must_use]
pub fn executions() -> Vec<Execution> {
    let plain = plain();
    let accelerations = [plain, Execution { acceleration: Acceleration::Auto, ..plain }];
    let shared = accelerations
        .into_iter()
        .flat_map(|e| [false, true].map(|s| Execution { share_samples: s, ..e }));
    shared.flat_map(|e| Lanes::ALL.map(|lanes| Execution { lanes, ..e })).collect()
}

/// Renders a scene in tiles of this side, the last one first. A pixel that no tile writes stays
/// NaN.
///
/// # Panics
///
/// If the scene is not sound, the side is 0, or an image of that size cannot be.
#[must_use]
pub fn in_tiles(
    scene: &Scene,
    (width, height): (u32, u32),
    execution: Execution,
    side: u32,
) -> Image {
    let work = tracer(scene, width, height, execution).expect("a sound scene");
    let mut image = Image::filled(width, height, [f32::NAN; 3]).expect("an image of this size");
    let tiles = image.tiles(NonZeroU32::new(side).expect("not 0"));
    tiles.into_iter().rev().for_each(|mut tile| work.render(&mut tile));
    image
}

/// Compares an execution of a scene, in one tile, with the plain one.
#[must_use]
pub fn difference_from_plain(
    scene: &Scene,
    size: (u32, u32),
    executions: impl IntoIterator<Item = Execution>,
) -> Option<String> {
    let right = in_tiles(scene, size, plain(), 1000);
    executions.into_iter().find_map(|execution| {
        let difference = difference(&in_tiles(scene, size, execution, 1000), &right)?;
        Some(format!("{}, {:?}: {difference}", scene.render.arithmetic.precision, execution.lanes))
    })
}

/// The executions with acceleration, in packets of every width.
#[must_use]
pub fn accelerated() -> [Execution; 3] {
    Lanes::ALL.map(|lanes| Execution { lanes, acceleration: Acceleration::Auto, ..plain() })
}

/// Says how many pixels differ in their bits, and where the first is; `None` if all are equal.
#[must_use]
pub fn difference(found: &Image, right: &Image) -> Option<String> {
    let bits = |color: &Rgb| color.map(f32::to_bits);
    let pairs = found.pixels().iter().zip(right.pixels()).enumerate();
    let different: Vec<_> =
        pairs.filter(|(_, (found, right))| bits(found) != bits(right)).collect();
    let (index, (found, expected)) = different.first()?;
    let (count, position) = (different.len(), right.position(*index));
    Some(format!("{count} pixels differ, the first at {position:?}: {found:?}, not {expected:?}"))
}

/// Renders one pixel at a time, the last one first: an order that no strategy has.
///
/// # Panics
///
/// If an image of that size cannot be.
#[must_use]
pub fn pixel_by_pixel(work: &dyn Work, width: u32, height: u32) -> Image {
    let mut image = Image::new(width, height).expect("an image of this size");
    for index in (0..image.pixels().len()).rev() {
        let (x, y) = image.position(index);
        work.render(&mut Tile::pixel(x, y, &mut image.pixels_mut()[index]));
    }
    image
}

/// Renders `scene` in this arithmetic, pixel by pixel.
///
/// # Panics
///
/// If the scene is not sound, or an image of that size cannot be.
#[must_use]
pub fn of_scene(
    scene: &Scene,
    width: u32,
    height: u32,
    arithmetic: impl Into<Arithmetic>,
) -> Image {
    pixel_by_pixel(&*work(scene, (width, height), arithmetic), width, height)
}

/// The work of rendering `scene` in this arithmetic.
///
/// # Panics
///
/// If the scene is not sound.
#[must_use]
pub fn work(
    scene: &Scene,
    (width, height): (u32, u32),
    arithmetic: impl Into<Arithmetic>,
) -> Box<dyn Work + Send> {
    tracer(&scene.with_arithmetic(arithmetic), width, height, Execution::default())
        .expect("a sound scene")
}

/// Returns the peak signal-to-noise ratio in dB of an image whose right colours are `truth`; NaN,
/// which is below every threshold, if a channel is NaN.
///
/// # Panics
///
/// If the two have different numbers of pixels.
#[must_use]
pub fn psnr(truth: &[[f64; 3]], image: &Image) -> f64 {
    if image.pixels().as_flattened().iter().any(|channel| channel.is_nan()) {
        return f64::NAN;
    }
    metrics::psnr(metrics::rmse(truth, image))
}
