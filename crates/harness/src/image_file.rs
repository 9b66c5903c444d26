//! The formats of image files. Writing one takes no more memory than [`ImageFormat::memory`] says.

use exr::block::writer::ChunksWriter;
use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::compression::Compression;
use exr::error::UnitResult;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, LineOrder, SampleType};
use exr::meta::header::Header;
use image::codecs::png::PngEncoder;
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::{ExtendedColorType, ImageEncoder, ImageError, ImageResult};
use rayweave_contract::Image;
use rayweave_scene_file::path_text;
use std::io::{self, Cursor, Seek, Write};
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
                path_text(path)
            )),
        }
    }

    /// Returns an upper bound of the memory that writing an image of this size takes, in bytes.
    pub fn memory(self, width: u32, height: u32) -> usize {
        let bytes = match self {
            // The bytes of the file, once as they are and once compressed.
            Self::Png => width as usize * height as usize * 3 * 2,
            Self::Ppm => width as usize * height as usize * 3,
            // A few copies of a block of 16 rows.
            Self::Exr => width as usize * 12 * 16 * 6,
        };
        // The rest is for buffers of a fixed size.
        bytes + (4 << 20)
    }

    /// Returns the contents of a file with this image.
    pub fn encode(self, image: &Image) -> Result<Vec<u8>, String> {
        let mut file = Cursor::new(Vec::new());
        let result = self.write(image, &mut file);
        result.map_err(|e| format!("the image cannot be encoded: {e}"))?;
        Ok(file.into_inner())
    }

    /// Writes the contents of a file with this image. `file` should have a buffer.
    pub fn write(self, image: &Image, file: &mut (impl Write + Seek)) -> io::Result<()> {
        match self {
            Self::Png => write_png(image, file).map_err(io_error),
            Self::Ppm => write_ppm(image, file).map_err(io_error),
            Self::Exr => write_exr(image, file).map_err(|error| match error {
                exr::error::Error::Io(error) => error,
                error => io::Error::other(error),
            }),
        }
    }
}

fn io_error(error: ImageError) -> io::Error {
    match error {
        ImageError::IoError(error) => error,
        error => io::Error::other(error),
    }
}

/// The length of a PNG's signature and header, which come first.
const PNG_HEADER: usize = 33;

/// The chunk that says that a viewer should show the bytes as sRGB (perceptual), with its checksum:
/// PNG specification (third edition, 2025), 11.3.2.5.
const SRGB_CHUNK: &[u8] = b"\0\0\0\x01sRGB\0\xae\xce\x1c\xe9";

/// Writes a PNG with an `sRGB` chunk, which the encoder does not write.
fn write_png(image: &Image, file: &mut impl Write) -> ImageResult<()> {
    let mut png = Vec::new();
    let (width, height) = (image.width(), image.height());
    PngEncoder::new(&mut png).write_image(
        &image.to_rgb8(),
        width,
        height,
        ExtendedColorType::Rgb8,
    )?;
    let (header, rest) = png.split_at(PNG_HEADER);
    [header, SRGB_CHUNK, rest].into_iter().try_for_each(|part| Ok(file.write_all(part)?))
}

fn write_ppm(image: &Image, file: &mut impl Write) -> ImageResult<()> {
    let (width, height) = (image.width(), image.height());
    PnmEncoder::new(file).with_subtype(PnmSubtype::Pixmap(SampleEncoding::Binary)).write_image(
        &image.to_rgb8(),
        width,
        height,
        ExtendedColorType::Rgb8,
    )
}

/// Writes an EXR of scan lines from the top, which every reader knows. Some readers refuse tiles,
/// or place them wrongly.
fn write_exr(image: &Image, file: &mut (impl Write + Seek)) -> UnitResult {
    let (width, height) = (image.width() as usize, image.height() as usize);
    // The channels of a file are in the order of their names.
    let channel = |name| ChannelDescription::named(name, SampleType::F32);
    let channels = ["B", "G", "R"].map(channel).into_iter().collect();
    let mut header = Header::new("".into(), (width, height), channels).with_encoding(
        Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    header.own_attributes.layer_name = None;
    let headers = std::iter::once(header).collect();
    exr::block::write(file, headers, true, |meta, writer| {
        for (number, index) in enumerate_ordered_header_block_indices(&meta.headers) {
            let first = index.pixel_position.y() * width;
            let rows = &image.pixels()[first..first + index.pixel_size.area()];
            let mut data = Vec::with_capacity(rows.len() * 12);
            for row in rows.chunks(width) {
                for channel in [2, 1, 0] {
                    // The library takes floats in the machine's order.
                    data.extend(row.iter().flat_map(|pixel| pixel[channel].to_ne_bytes()));
                }
            }
            let block = UncompressedBlock { index, data };
            writer.write_chunk(number, block.compress_to_chunk(&meta.headers)?)?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests;
