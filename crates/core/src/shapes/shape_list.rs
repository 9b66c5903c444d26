//! The list of all shapes of one kind, and the ranges of it that are tried together.
//!
//! A shape has a number, which decides between equal distances, and a position in its list. The
//! positions may be rearranged, so that shapes that are tried together lie next to each other.

use std::ops::Range;

/// A few primitives that are tried together, as ranges of positions in each kind's list.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Leaf {
    pub(crate) spheres: Range<u32>,
    pub(crate) triangles: Range<u32>,
    pub(crate) cylinders: Range<u32>,
}

/// The shapes of one kind, in the order in which they are tried.
#[derive(Debug)]
pub(crate) struct ShapeList<T> {
    pub(crate) shapes: Vec<T>,
    /// The number of each shape.
    numbers: Vec<u32>,
    /// The position of each shape, by its number less that of the kind's first.
    positions: Vec<u32>,
    /// The smallest number of the kind.
    pub(crate) first: u32,
}

impl<T: Clone> ShapeList<T> {
    /// Rearranges the shapes in this order of their present positions.
    pub(crate) fn arrange(&mut self, order: &[u32]) {
        self.shapes = order.iter().map(|&i| self.shapes[i as usize].clone()).collect();
        self.numbers = order.iter().map(|&i| self.numbers[i as usize]).collect();
        for (position, &number) in (0..).zip(&self.numbers) {
            self.positions[(number - self.first) as usize] = position;
        }
    }
}

impl<T> ShapeList<T> {
    /// Makes a shape of each primitive; their numbers begin at `first`.
    pub(crate) fn new<P>(primitives: &[P], first: usize, shape: impl Fn(&P) -> T) -> Self {
        let count = primitives.len() as u32;
        Self {
            shapes: primitives.iter().map(shape).collect(),
            numbers: (first as u32..first as u32 + count).collect(),
            positions: (0..count).collect(),
            first: first as u32,
        }
    }

    /// Returns the shape with this number, unless it is of another kind.
    #[inline(always)]
    pub(crate) fn get(&self, number: u32) -> Option<&T> {
        let position = *self.positions.get(number.checked_sub(self.first)? as usize)?;
        self.shapes.get(position as usize)
    }

    /// Returns the shape with this number.
    ///
    /// # Panics
    ///
    /// If it is of another kind.
    #[inline(always)]
    pub(crate) fn of_kind(&self, number: u32) -> &T {
        &self.shapes[self.positions[(number - self.first) as usize] as usize]
    }

    /// Returns the shapes in a range of positions, with their numbers.
    #[inline(always)]
    pub(crate) fn range(&self, range: &Range<u32>) -> impl Iterator<Item = (u32, &T)> {
        let range = range.start as usize..range.end as usize;
        self.numbers[range.clone()].iter().copied().zip(&self.shapes[range])
    }
}
