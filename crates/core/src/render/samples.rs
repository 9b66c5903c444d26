//! Lists of samples: where they lie, and what colour each has.

use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;
use crate::trace::Traced;
use std::iter::repeat_n;
use std::ops::Range;

/// Places, in half steps of the filter's: from the middle of the picture or, of a filter's samples,
/// from the centre of a pixel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places<S> {
    right: Vec<S>,
    down: Vec<S>,
}

impl<S: Scalar> Places<S> {
    pub(crate) fn len(&self) -> usize {
        self.right.len()
    }

    pub(crate) fn clear(&mut self) {
        self.right.clear();
        self.down.clear();
    }

    pub(crate) fn push(&mut self, right: S, down: S) {
        self.right.push(right);
        self.down.push(down);
    }

    /// Adds, for each pixel's centre (one of `rights`, `down`) in turn, the places of all of its
    /// `samples` in their order.
    #[inline(always)]
    pub(crate) fn push_around(&mut self, rights: &[S], down: S, samples: &Self) {
        // With one sample a pixel the general loop is a noticeable share of a rendering.
        if let ([aside], [below]) = (&*samples.right, &*samples.down) {
            self.right.extend(rights.iter().map(|&right| right + *aside));
            self.down.extend(repeat_n(down + *below, rights.len()));
            return;
        }
        for &right in rights {
            self.right.extend(samples.right.iter().map(|&aside| right + aside));
            self.down.extend(samples.down.iter().map(|&below| down + below));
        }
    }

    /// The places from number `first` on: right and down. Lanes beyond the last repeat some of
    /// them.
    #[inline(always)]
    pub(crate) fn load<L: Lane<Scalar = S>>(&self, first: usize) -> (L, L) {
        if first + L::LANES <= self.len() {
            return (L::load(&self.right[first..]), L::load(&self.down[first..]));
        }
        let filled =
            |numbers: &[S]| L::from_fn(|lane| numbers[first + lane % (numbers.len() - first)]);
        (filled(&self.right), filled(&self.down))
    }
}

/// So many steps of the lattice, as a distance between places: exactly.
#[inline(always)]
pub(crate) fn half_steps<S: Scalar>(steps: i64) -> S {
    S::from_f64(2.0 * steps as f64)
}

/// The colours of samples: red, green and blue each in a list of its own.
#[derive(Debug, Default)]
pub(crate) struct Colors<S> {
    pub(crate) channels: [Vec<S>; 3],
    /// What each saw, see [`Traced`]; none if nobody asks.
    pub(crate) path_hashes: Vec<u32>,
}

impl<S: Scalar> Colors<S> {
    /// Room for so many; for their path hashes too if somebody asks for them.
    pub(crate) fn resize(&mut self, count: usize, path_hashes: bool) {
        for channel in &mut self.channels {
            channel.resize(count, S::literal(0.0));
        }
        self.path_hashes.resize(if path_hashes { count } else { 0 }, 0);
    }

    /// The colours of these samples.
    #[inline(always)]
    pub(crate) fn range(&self, samples: Range<usize>) -> impl Iterator<Item = Vector<S>> {
        let [red, green, blue] = self.channels.each_ref().map(|channel| &channel[samples.clone()]);
        red.iter().zip(green).zip(blue).map(|((&red, &green), &blue)| Vector::new(red, green, blue))
    }

    #[inline(always)]
    pub(crate) fn store<L: Lane<Scalar = S>>(
        &mut self,
        first: usize,
        Traced { color, path_hash }: Traced<L>,
    ) {
        let [red, green, blue] = &mut self.channels;
        color.x.store(&mut red[first..]);
        color.y.store(&mut green[first..]);
        color.z.store(&mut blue[first..]);
        if let Some(path_hashes) = self.path_hashes.get_mut(first..).filter(|rest| !rest.is_empty())
        {
            L::store_index(path_hash, path_hashes);
        }
    }
}
