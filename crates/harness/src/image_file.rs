//! The formats of image files. Each is written row by row, so that an image of any size takes only
//! the memory that [`ImageFormat::memory`] says.

use exr::block::writer::ChunksWriter;
use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::compression::Compression;
use exr::error::UnitResult;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, LineOrder, SampleType};
use exr::meta::header::Header;
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

    /// Returns an upper bound of the memory that writing an image of this width takes, in bytes.
    pub fn memory(self, width: u32) -> usize {
        // Bytes a pixel, and rows: of a block of EXR there are a few copies.
        let (bytes, rows) = if self == Self::Exr { (12, 16 * 6) } else { (3, 6) };
        // The rest is for buffers of a fixed size.
        width as usize * bytes * rows + (4 << 20)
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
            Self::Png => write_png(image, file).map_err(io::Error::from),
            Self::Ppm => write_ppm(image, file),
            Self::Exr => write_exr(image, file).map_err(|error| match error {
                exr::error::Error::Io(error) => error,
                error => io::Error::other(error),
            }),
        }
    }
}

/// Writes a PNG with the chunk that says that a viewer should show the bytes as sRGB.
fn write_png(image: &Image, file: &mut impl Write) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(file, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer()?;
    for y in 0..image.height() {
        rows.write_all(&image.row_to_rgb8(y))?;
    }
    rows.finish()?;
    writer.finish()
}

fn write_ppm(image: &Image, file: &mut impl Write) -> io::Result<()> {
    write!(file, "P6\n{} {} 255\n", image.width(), image.height())?;
    (0..image.height()).try_for_each(|y| file.write_all(&image.row_to_rgb8(y)))
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
