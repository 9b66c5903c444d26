//! The formats of image files.

use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::PngEncoder;
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use rayweave_contract::Image;
use std::io::Cursor;
use std::path::Path;

/// A format of image files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// 8 bits a channel.
    Png,
    /// 8 bits a channel, uncompressed.
    Ppm,
    /// The linear floats as they are.
    Exr,
}

impl ImageFormat {
    /// Returns the format of a file by its extension.
    pub fn of(path: &Path) -> Result<Self, String> {
        let extension =
            path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "ppm" => Ok(Self::Ppm),
            "exr" => Ok(Self::Exr),
            _ => Err(format!(
                "{}: the name of an image file must end in .png, .ppm or .exr",
                path.display()
            )),
        }
    }

    /// Returns the contents of a file with this image.
    pub fn encode(self, image: &Image) -> Result<Vec<u8>, String> {
        let mut file = Cursor::new(Vec::new());
        let (width, height) = (image.width(), image.height());
        let result: ImageResult<()> = match self {
            Self::Png => PngEncoder::new(&mut file).write_image(
                &image.to_rgb8(),
                width,
                height,
                ExtendedColorType::Rgb8,
            ),
            Self::Ppm => PnmEncoder::new(&mut file)
                .with_subtype(PnmSubtype::Pixmap(SampleEncoding::Binary))
                .write_image(&image.to_rgb8(), width, height, ExtendedColorType::Rgb8),
            Self::Exr => {
                // The encoder takes the floats as bytes in the machine's order.
                let floats: Vec<u8> =
                    image.pixels().as_flattened().iter().flat_map(|c| c.to_ne_bytes()).collect();
                OpenExrEncoder::new(&mut file).write_image(
                    &floats,
                    width,
                    height,
                    ExtendedColorType::Rgb32F,
                )
            }
        };
        result.map_err(|e| format!("the image cannot be encoded: {e}"))?;
        Ok(file.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Image {
        let mut sample = Image::new(2, 1).expect("a small image");
        // 0.5 is 127.5 + 0.5; 0.1 is 25.5 + 0.5; NaN becomes black.
        sample.pixels_mut().copy_from_slice(&[[0.5, -1.0, 2.0], [0.1, f32::NAN, 0.998]]);
        sample
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
    fn an_exr_keeps_every_bit() {
        let mut sample = sample();
        sample.pixels_mut()[1] = [1e-30, 3.5, 0.1];
        let file = ImageFormat::Exr.encode(&sample).expect("encodes");
        let decoded = image::load_from_memory(&file).expect("decodes").into_rgb32f();
        let bits = |floats: &[f32]| floats.iter().map(|c| c.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(decoded.as_raw()), bits(sample.pixels().as_flattened()));
    }

    #[test]
    fn the_extension_decides() {
        assert_eq!(ImageFormat::of(Path::new("a.b/c.PNG")), Ok(ImageFormat::Png));
        assert!(ImageFormat::of(Path::new("png")).is_err());
        assert!(ImageFormat::of(Path::new("a.jpg")).is_err());
    }
}
