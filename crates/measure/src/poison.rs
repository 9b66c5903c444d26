//! What a picture holds before it is rendered, so that a pixel that nobody writes shows itself.

use rayweave_contract::{Image, Rgb};

/// A quiet NaN whose payload no arithmetic produces.
const PAYLOAD: u32 = 0x7fc0_dead;

/// Overwrites the whole picture with the poison.
pub(crate) fn fill(image: &mut Image) {
    image.fill([f32::from_bits(PAYLOAD); 3]);
}

/// Whether a pixel is as [`fill`] left it.
pub(crate) fn untouched(color: Rgb) -> bool {
    color.iter().all(|channel| channel.to_bits() == PAYLOAD)
}
