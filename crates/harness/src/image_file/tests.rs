//! The files, byte by byte and as others read them: a decoder of its own for EXR, and whichever of
//! Pillow and TinyEXR is installed. `RAYWEAVE_READERS=pillow,tinyexr` says that they must be.

mod exr_decoder;
mod readers;

use super::*;

fn sample() -> Image {
    let mut sample = Image::new(2, 1).expect("a small image");
    // 0.5 is 127.5 + 0.5; 0.1 is 25.5 + 0.5; NaN becomes black.
    sample.pixels_mut().copy_from_slice(&[[0.5, -1.0, 2.0], [0.1, f32::NAN, 0.998]]);
    sample
}

/// Returns three blocks of rows with everything that a float can be. The upper half is smooth, the
/// lower half cannot be compressed.
fn large_sample() -> Image {
    let mut image = Image::new(37, 35).expect("a small image");
    let mut state = 1_u32;
    for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
        *pixel = [0, 1, 2].map(|channel| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f32::from_bits(state ^ state >> 15);
            if index < 37 * 20 { (index + 1000 * channel) as f32 / 740.0 } else { noise }
        });
    }
    let special = [-0.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e-45, 1e-30, f32::MAX, 0.1];
    image.pixels_mut().as_flattened_mut()[5..13].copy_from_slice(&special);
    image
}

fn bits(image: &Image) -> Vec<u32> {
    image.pixels().as_flattened().iter().map(|channel| channel.to_bits()).collect()
}

#[test]
fn eight_bits_are_rounded_half_up_and_clamped() {
    assert_eq!(sample().to_rgb8(), [128, 0, 255, 26, 0, 254]);
}

#[test]
fn a_ppm_is_a_header_and_the_bytes() {
    let file = ImageFormat::Ppm.encode(&sample()).expect("encodes");
    assert_eq!(file, b"P6\n2 1 255\n\x80\x00\xff\x1a\x00\xfe");
}

#[test]
fn a_png_says_that_its_bytes_are_shown_as_srgb() {
    let file = ImageFormat::Png.encode(&sample()).expect("encodes");
    // Length, name and data of the first two chunks, each with a checksum behind it.
    assert_eq!(file[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(file[8..29], *b"\0\0\0\x0dIHDR\0\0\0\x02\0\0\0\x01\x08\x02\0\0\0");
    assert_eq!(file[33..42], *b"\0\0\0\x01sRGB\0");
    assert_eq!(file.windows(4).filter(|name| name == b"gAMA" || name == b"iCCP").count(), 0);
}

#[test]
fn an_exr_has_scan_lines_from_the_top_and_keeps_every_bit() {
    for image in [sample(), large_sample()] {
        let file = ImageFormat::Exr.encode(&image).expect("encodes");
        let decoded = exr_decoder::decode(&file);
        assert_eq!((decoded.width, decoded.height), (image.width(), image.height()));
        assert_eq!(decoded.bits, bits(&image));
    }
}

#[test]
fn the_extension_decides() {
    assert_eq!(ImageFormat::of(Path::new("a.b/c.PNG")), Ok(ImageFormat::Png));
    assert!(ImageFormat::of(Path::new("png")).is_err());
    assert!(ImageFormat::of(Path::new("a.jpg")).is_err());
}
