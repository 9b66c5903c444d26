//! A rectangle of the image together with the row slices that it alone may write.
//!
//! The borrow checker proves that tiles are disjoint, so threads fill them at the same time without
//! a lock and without `unsafe`.

use crate::image::Rgb;
use std::fmt;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rect {
    /// Column of its left pixels.
    pub x: u32,
    /// Row of its top pixels.
    pub y: u32,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
}

impl Rect {
    /// Whether pixel `(x, y)` is in it.
    #[must_use]
    pub fn contains(&self, x: u32, y: u32) -> bool {
        // Wrapping: what lies before it becomes far too large.
        x.wrapping_sub(self.x) < self.width && y.wrapping_sub(self.y) < self.height
    }
}

impl fmt::Display for Rect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{} at ({}, {})", self.width, self.height, self.x, self.y)
    }
}

/// A rectangle of the picture and the sole right to write it.
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
    /// The tile of the single pixel `(x, y)`, wherever its colour is kept.
    #[must_use]
    pub fn pixel(x: u32, y: u32, color: &'a mut Rgb) -> Self {
        Self::row(x, y, std::slice::from_mut(color))
    }

    /// The tile of the pixels from `(x, y)` to the right, wherever their colours are kept: as many
    /// as there are colours, 65,535 at the most in a picture that a scene may ask for.
    #[must_use]
    pub fn row(x: u32, y: u32, colors: &'a mut [Rgb]) -> Self {
        let rect = Rect { x, y, width: colors.len() as u32, height: 1 };
        Self { rect, rows: Rows::One(colors) }
    }

    /// The tile of whole rows of a picture from row `y` down, wherever their colours are kept: row
    /// after row, each of `width` pixels.
    ///
    /// # Panics
    ///
    /// Unless `colors` are one row or more, and no part of one.
    #[must_use]
    pub fn band(y: u32, width: u32, colors: &'a mut [Rgb]) -> Self {
        let row = width as usize;
        assert!(
            !colors.is_empty() && colors.len().is_multiple_of(row),
            "whole rows of {width} pixels"
        );
        Self::of_rows(0, y, colors.chunks_exact_mut(row))
    }

    /// The tile of one row or more.
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

    /// Which pixels of the picture these are.
    #[must_use]
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// The pixels of row `y`, counted from the tile's top.
    ///
    /// # Panics
    ///
    /// Unless `y` is below the tile's height.
    #[must_use]
    pub fn row_mut(&mut self, y: usize) -> &mut [Rgb] {
        match &mut self.rows {
            Rows::One(row) => std::slice::from_mut(row)[y],
            Rows::Many(rows) => rows[y],
        }
    }

    /// The rows from the top, each with its y and its pixels from the left.
    pub fn rows(&mut self) -> impl Iterator<Item = (u32, &mut [Rgb])> {
        let rows = match &mut self.rows {
            Rows::One(row) => std::slice::from_mut(row),
            Rows::Many(rows) => rows.as_mut_slice(),
        };
        (self.rect.y..).zip(rows.iter_mut().map(|row| &mut **row))
    }
}
