//! The shapes of one kind: how their places and their numbers go together, and which are tried
//! together.

use std::ops::Range;

/// A few primitives that are tried together: ranges of places.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Leaf {
    pub(crate) spheres: Range<u32>,
    pub(crate) triangles: Range<u32>,
    pub(crate) cylinders: Range<u32>,
}

/// The primitives of one kind, in the order in which they are tried.
#[derive(Debug)]
pub(crate) struct Kind<T> {
    pub(crate) shapes: Vec<T>,
    /// Of each shape.
    pub(crate) numbers: Vec<u32>,
    /// Where each shape is, by its number less the kind's first.
    pub(crate) places: Vec<u32>,
    pub(crate) first: u32,
}

impl<T: Clone> Kind<T> {
    /// Puts the shapes in this order of their present places.
    pub(crate) fn arrange(&mut self, order: &[u32]) {
        self.shapes = order.iter().map(|&place| self.shapes[place as usize].clone()).collect();
        self.numbers = order.iter().map(|&place| self.numbers[place as usize]).collect();
        for (place, &number) in (0..).zip(&self.numbers) {
            self.places[(number - self.first) as usize] = place;
        }
    }
}

impl<T> Kind<T> {
    pub(crate) fn new<P>(primitives: &[P], first: usize, shape: impl Fn(&P) -> T) -> Self {
        let count = primitives.len() as u32;
        Self {
            shapes: primitives.iter().map(shape).collect(),
            numbers: (first as u32..first as u32 + count).collect(),
            places: (0..count).collect(),
            first: first as u32,
        }
    }

    /// The shape with this number, unless it is of another kind.
    #[inline(always)]
    pub(crate) fn get(&self, number: u32) -> Option<&T> {
        let place = *self.places.get(number.checked_sub(self.first)? as usize)?;
        self.shapes.get(place as usize)
    }

    #[inline(always)]
    pub(crate) fn range(&self, range: &Range<u32>) -> impl Iterator<Item = (u32, &T)> {
        let range = range.start as usize..range.end as usize;
        self.numbers[range.clone()].iter().copied().zip(&self.shapes[range])
    }
}
