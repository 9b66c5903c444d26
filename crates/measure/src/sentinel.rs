//! The sentinel that fills an image before it is rendered, to find pixels that are not written.

use rayweave_contract::{Image, Rgb};

/// A quiet NaN whose payload no arithmetic produces.
const PAYLOAD: u32 = 0x7fc0_dead;

/// Overwrites every pixel of `image` with the sentinel.
pub(crate) fn fill(image: &mut Image) {
    image.fill([f32::from_bits(PAYLOAD); 3]);
}

/// Returns whether a pixel still holds the sentinel.
pub(crate) fn untouched(color: Rgb) -> bool {
    color.iter().all(|channel| channel.to_bits() == PAYLOAD)
}
