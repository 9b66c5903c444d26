//! Pictures without any strategy: whatever is true of them is true of the work alone.

use rayweave_core::{Image, Precision, Scene, Tile, Work, tracer};

/// Computed one pixel at a time, the last one first: in an order that no strategy has.
///
/// # Panics
///
/// If a picture of that size cannot be.
#[must_use]
pub fn pixel_by_pixel(work: &dyn Work, width: u32, height: u32) -> Image {
    let mut picture = Image::new(width, height).expect("a picture of this size");
    for index in (0..picture.pixels().len()).rev() {
        let (x, y) = picture.position(index);
        work.render(&mut Tile::pixel(x, y, &mut picture.pixels_mut()[index]));
    }
    picture
}

/// The picture of `scene`.
///
/// # Panics
///
/// If the scene is not sound, or a picture of that size cannot be.
#[must_use]
pub fn of_scene(scene: &Scene, width: u32, height: u32, precision: Precision) -> Image {
    let work = tracer(scene, width, height, precision).expect("a sound scene");
    pixel_by_pixel(&*work, width, height)
}
