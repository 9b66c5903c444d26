//! The image, its digest, and its division into tiles.

use crate::tile::{Rgb, Tile};
use sha2::{Digest as _, Sha256};
use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;
use thiserror::Error;

/// The most pixels an [`Image`] may have: 2^28, which is 3 GiB.
pub const MAX_PIXELS: u64 = 1 << 28;

/// An image in linear light, row by row from the top, each row from the left.
///
/// Two images are the same when their bits are: compare [`Image::digest`]s, or pixels with
/// [`f32::to_bits`]. `==` compares bits too, so a NaN equals itself.
///
/// ```
/// use rayweave_contract::Image;
///
/// let mut image = Image::new(3, 2)?;
/// image.pixels_mut()[4] = [0.25, 0.5, f32::NAN];
/// assert_eq!(image.position(4), (1, 1));
/// assert_eq!(image, image.clone());
/// # Ok::<(), rayweave_contract::ImageError>(())
/// ```
#[derive(Clone)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

/// The reason why there is no image of a size.
///
/// ```
/// use rayweave_contract::{Image, ImageError};
///
/// let error = Image::new(3, 0).unwrap_err();
/// assert_eq!(error, ImageError::Empty { width: 3, height: 0 });
/// assert!(error.to_string().ends_with("choose a width and a height of 1 or more"));
/// ```
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum ImageError {
    /// It has more than [`MAX_PIXELS`] pixels.
    #[error(
        "an image of {width} x {height} pixels is over the limit of {MAX_PIXELS} pixels: \
         choose a smaller size"
    )]
    TooLarge {
        /// The width in pixels.
        width: u32,
        /// The height in pixels.
        height: u32,
    },
    /// Its width or height is 0.
    #[error(
        "an image of {width} x {height} has no pixels: choose a width and a height of 1 or more"
    )]
    Empty {
        /// The width in pixels.
        width: u32,
        /// The height in pixels.
        height: u32,
    },
    /// The allocator refused the memory.
    #[error("no memory for an image of {width} x {height} pixels: choose a smaller size")]
    NoMemory {
        /// The width in pixels.
        width: u32,
        /// The height in pixels.
        height: u32,
    },
}

impl Image {
    /// Returns an image of `width` x `height` pixels, all filled with `color`.
    ///
    /// # Errors
    ///
    /// [`ImageError`]: a size without pixels, above [`MAX_PIXELS`], or too large for the allocator.
    pub fn filled(width: u32, height: u32, color: Rgb) -> Result<Self, ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError::Empty { width, height });
        }
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(ImageError::TooLarge { width, height });
        }
        let count = width as usize * height as usize;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| ImageError::NoMemory { width, height })?;
        pixels.resize(count, color);
        Ok(Self { width, height, pixels })
    }

    /// Returns a black image of `width` x `height` pixels.
    ///
    /// # Errors
    ///
    /// As [`Image::filled`].
    pub fn new(width: u32, height: u32) -> Result<Self, ImageError> {
        Self::filled(width, height, [0.0; 3])
    }

    /// Returns the width in pixels, 1 or more.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels, 1 or more.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the pixels row by row from the top: pixel `(x, y)` is number `y * width + x`.
    #[must_use]
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// Returns the pixels as [`Image::pixels`] does, for writing.
    #[must_use]
    pub fn pixels_mut(&mut self) -> &mut [Rgb] {
        &mut self.pixels
    }

    /// Returns the column and the row of pixel number `index`.
    #[must_use]
    pub fn position(&self, index: usize) -> (u32, u32) {
        let width = self.width as usize;
        ((index % width) as u32, (index / width) as u32)
    }

    /// Returns each channel in 8 bits: `floor(255 clamp(c, 0, 1) + 0.5)`, without gamma. A NaN
    /// gives 0.
    #[must_use]
    pub fn to_rgb8(&self) -> Vec<u8> {
        let byte =
            |channel: &f32| (255.0 * f64::from(*channel).clamp(0.0, 1.0) + 0.5).floor() as u8;
        self.pixels.as_flattened().iter().map(byte).collect()
    }

    /// Overwrites every pixel with `color`.
    pub fn fill(&mut self, color: Rgb) {
        self.pixels.fill(color);
    }

    /// Cuts the image into squares of `size` pixels a side, from the top, each row of tiles from
    /// the left. The last tiles of a row or a column are smaller where the image ends.
    #[must_use]
    pub fn tiles(&mut self, size: NonZeroU32) -> Vec<Tile<'_>> {
        let (width, size) = (self.width as usize, size.get().min(self.width.max(self.height)));
        let count = |length: u32| length.div_ceil(size) as usize;
        let mut tiles = Vec::with_capacity(count(self.width) * count(self.height));
        for (y, band) in (0..self.height)
            .step_by(size as usize)
            .zip(self.pixels.chunks_mut(width * size as usize))
        {
            let mut rows: Vec<_> =
                band.chunks_mut(width).map(|row| row.chunks_mut(size as usize)).collect();
            for x in (0..self.width).step_by(size as usize) {
                // As many columns as `x` has values are in each row.
                let slices = rows.iter_mut().map(|row| row.next().unwrap_or_default());
                tiles.push(Tile::of_rows(x, y, slices));
            }
        }
        tiles
    }

    /// Returns the SHA-256 over width, height (as 32-bit integers) and the bits of every channel,
    /// all little-endian.
    #[must_use]
    pub fn digest(&self) -> Digest {
        let mut hash = Sha256::new();
        hash.update(self.width.to_le_bytes());
        hash.update(self.height.to_le_bytes());
        // A row at a time: one call a channel would cost more than the hash itself.
        let mut bytes = Vec::with_capacity(self.width as usize * size_of::<Rgb>());
        for row in self.pixels.chunks(self.width as usize) {
            bytes.clear();
            bytes.extend(row.as_flattened().iter().flat_map(|channel| channel.to_le_bytes()));
            hash.update(&bytes);
        }
        Digest(hash.finalize().into())
    }
}

impl PartialEq for Image {
    fn eq(&self, other: &Self) -> bool {
        let bits = |image: &Self| -> Vec<u32> {
            image.pixels.as_flattened().iter().map(|c| c.to_bits()).collect()
        };
        (self.width, self.height) == (other.width, other.height) && bits(self) == bits(other)
    }
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Image({} x {}, {})", self.width, self.height, self.digest())
    }
}

/// The fingerprint of an image: equal exactly when size and bits are.
///
/// ```
/// use rayweave_contract::{Digest, Image};
///
/// let digest = Image::new(3, 2)?.digest();
/// assert_ne!(digest, Image::new(2, 3)?.digest());
/// assert_eq!(digest.to_string().parse::<Digest>()?, digest);
/// assert!(digest.to_string().starts_with(&digest.short()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Digest([u8; 32]);

impl Digest {
    /// Returns the first 16 hexadecimal digits, enough for a table.
    #[must_use]
    pub fn short(&self) -> String {
        let mut text = self.to_string();
        text.truncate(16);
        text
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Reads the 64 hexadecimal digits that a digest is displayed as.
impl FromStr for Digest {
    type Err = ParseDigestError;

    fn from_str(text: &str) -> Result<Self, ParseDigestError> {
        let mut bytes = [0; 32];
        if text.len() != 2 * bytes.len() || !text.bytes().all(|digit| digit.is_ascii_hexdigit()) {
            return Err(ParseDigestError);
        }
        for (byte, place) in bytes.iter_mut().zip((0..).step_by(2)) {
            *byte =
                u8::from_str_radix(&text[place..place + 2], 16).map_err(|_| ParseDigestError)?;
        }
        Ok(Self(bytes))
    }
}

/// The error for a text that is not a [`Digest`].
///
/// ```
/// assert!("123".parse::<rayweave_contract::Digest>().is_err());
/// ```
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("a digest has 64 hexadecimal digits")]
pub struct ParseDigestError;

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
