//! A rectangle of the image together with the row slices that it alone may write.
//!
//! The borrow checker proves that tiles are disjoint, so threads fill them at the same time without
//! a lock and without `unsafe`.

use std::fmt;

/// A linear RGB colour, not clamped.
pub type Rgb = [f32; 3];

/// A rectangle of pixels.
///
/// ```
/// use rayweave_contract::Rect;
///
/// let rect = Rect { x: 4, y: 8, width: 2, height: 1 };
/// assert!(rect.contains(5, 8) && !rect.contains(6, 8));
/// assert_eq!(rect.to_string(), "2x1 at (4, 8)");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rect {
    /// The column of its leftmost pixels.
    pub x: u32,
    /// The row of its topmost pixels.
    pub y: u32,
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
}

impl Rect {
    /// Returns whether pixel `(x, y)` is in the rectangle.
    #[must_use]
    pub fn contains(&self, x: u32, y: u32) -> bool {
        // Wrapping: the difference to a pixel before it becomes far too large.
        x.wrapping_sub(self.x) < self.width && y.wrapping_sub(self.y) < self.height
    }
}

impl fmt::Display for Rect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{} at ({}, {})", self.width, self.height, self.x, self.y)
    }
}

/// A rectangle of the image and the sole right to write it.
///
/// ```
/// use rayweave_contract::Image;
/// use std::num::NonZeroU32;
///
/// let mut image = Image::new(5, 3)?;
/// let mut tiles = image.tiles(NonZeroU32::new(2).unwrap());
/// let sizes: Vec<(u32, u32)> =
///     tiles.iter().map(|tile| (tile.rect().width, tile.rect().height)).collect();
/// assert_eq!(sizes, [(2, 2), (2, 2), (1, 2), (2, 1), (2, 1), (1, 1)]);
/// // The tiles are disjoint, so threads may fill them at the same time.
/// std::thread::scope(|scope| {
///     for tile in &mut tiles {
///         scope.spawn(|| tile.rows().for_each(|(y, row)| row.fill([y as f32; 3])));
///     }
/// });
/// assert_eq!(image.pixels()[14], [2.0; 3]);
/// # Ok::<(), rayweave_contract::ImageError>(())
/// ```
#[derive(Debug)]
pub struct Tile<'a> {
    rect: Rect,
    rows: Rows<'a>,
}

/// A single row needs no allocation: there are as many one-pixel tiles as pixels.
#[derive(Debug)]
enum Rows<'a> {
    One(&'a mut [Rgb]),
    Many(Vec<&'a mut [Rgb]>),
}

impl<'a> Tile<'a> {
    /// Returns the tile of the single pixel `(x, y)`, whose colour may be kept anywhere.
    #[must_use]
    pub fn pixel(x: u32, y: u32, color: &'a mut Rgb) -> Self {
        Self::row(x, y, std::slice::from_mut(color))
    }

    /// Returns the tile of the pixels from `(x, y)` to the right, one for each of `colors`, which
    /// may be kept anywhere. There are at most 65,535 in an image that a scene may ask for.
    #[must_use]
    pub fn row(x: u32, y: u32, colors: &'a mut [Rgb]) -> Self {
        let rect = Rect { x, y, width: colors.len() as u32, height: 1 };
        Self { rect, rows: Rows::One(colors) }
    }

    /// Returns the tile of whole rows of an image from row `y` down. Their colours may be kept
    /// anywhere: row after row, each of `width` pixels.
    ///
    /// # Panics
    ///
    /// `colors` has no row, or a part of one.
    #[must_use]
    pub fn band(y: u32, width: u32, colors: &'a mut [Rgb]) -> Self {
        let row = width as usize;
        assert!(
            !colors.is_empty() && colors.len().is_multiple_of(row),
            "whole rows of {width} pixels"
        );
        Self::of_rows(0, y, colors.chunks_exact_mut(row))
    }

    /// Returns the tile of one row or more.
    pub(crate) fn of_rows(
        x: u32,
        y: u32,
        mut rows: impl ExactSizeIterator<Item = &'a mut [Rgb]>,
    ) -> Self {
        let height = rows.len();
        let first = rows.next().unwrap_or_default();
        let rect = Rect { x, y, width: first.len() as u32, height: height as u32 };
        if height == 1 {
            return Self { rect, rows: Rows::One(first) };
        }
        let mut many = Vec::with_capacity(height);
        many.push(first);
        many.extend(rows);
        Self { rect, rows: Rows::Many(many) }
    }

    /// Returns the position and the size of the tile in the image.
    #[must_use]
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// Returns the pixels of row `y`, counted from the top of the tile.
    ///
    /// # Panics
    ///
    /// `y` is not below the tile's height.
    #[must_use]
    pub fn row_mut(&mut self, y: usize) -> &mut [Rgb] {
        match &mut self.rows {
            Rows::One(row) => std::slice::from_mut(row)[y],
            Rows::Many(rows) => rows[y],
        }
    }

    /// Returns the rows from the top, each with its y in the image and its pixels from the left.
    pub fn rows(&mut self) -> impl Iterator<Item = (u32, &mut [Rgb])> {
        let rows = match &mut self.rows {
            Rows::One(row) => std::slice::from_mut(row),
            Rows::Many(rows) => rows.as_mut_slice(),
        };
        (self.rect.y..).zip(rows.iter_mut().map(|row| &mut **row))
    }
}
