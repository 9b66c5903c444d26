//! Images without any strategy: whatever is true of them is true of the work alone.

use rayweave_contract::{Image, Rgb, Tile, Work};
use rayweave_core::{Acceleration, Execution, Lanes, Precision, Scene, tracer};
use std::num::NonZeroU32;

/// The execution that has nothing of the others': each ray for itself, and against each primitive.
#[must_use]
pub fn plain() -> Execution {
    let (lanes, acceleration) = (Lanes::One, Acceleration::None);
    Execution { lanes, share_samples: false, acceleration }
}

/// Every execution; the first is the plain one.
#[must_use]
pub fn executions() -> Vec<Execution> {
    let plain = plain();
    let accelerations = [plain, Execution { acceleration: Acceleration::Auto, ..plain }];
    let shared = accelerations
        .into_iter()
        .flat_map(|e| [false, true].map(|s| Execution { share_samples: s, ..e }));
    shared.flat_map(|e| Lanes::ALL.map(|lanes| Execution { lanes, ..e })).collect()
}

/// The image in tiles of this side, the last one first; what no tile writes stays NaN.
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

/// Which pixels have other bits, if any: how many, and the first of them.
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

/// Computed one pixel at a time, the last one first: in an order that no strategy has.
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

/// The image of `scene` with the robust formulas in this precision.
///
/// # Panics
///
/// If the scene is not sound, or an image of that size cannot be.
#[must_use]
pub fn of_scene(scene: &Scene, width: u32, height: u32, precision: Precision) -> Image {
    let work = tracer(&scene.with_arithmetic(precision), width, height, Execution::default())
        .expect("a sound scene");
    pixel_by_pixel(&*work, width, height)
}
