//! Lists of samples: their positions, and their colours.

use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;
use crate::trace::Traced;
use std::iter::repeat_n;
use std::ops::Range;

/// Positions of samples, in half lattice steps: from the middle of the image or, for the samples of
/// a filter, from the centre of a pixel.
#[derive(Clone, Debug, Default)]
pub(crate) struct SamplePositions<S> {
    xs: Vec<S>,
    ys: Vec<S>,
}

impl<S: Scalar> SamplePositions<S> {
    pub(crate) fn len(&self) -> usize {
        self.xs.len()
    }

    pub(crate) fn clear(&mut self) {
        self.xs.clear();
        self.ys.clear();
    }

    pub(crate) fn push(&mut self, x: S, y: S) {
        self.xs.push(x);
        self.ys.push(y);
    }

    /// Adds the positions of all `samples` around each pixel centre in turn. The centres are (one
    /// of `xs`, `y`).
    #[inline(always)]
    pub(crate) fn push_around(&mut self, xs: &[S], y: S, samples: &Self) {
        // With one sample a pixel, the general loop would be a noticeable share of the rendering.
        if let ([dx], [dy]) = (&*samples.xs, &*samples.ys) {
            self.xs.extend(xs.iter().map(|&x| x + *dx));
            self.ys.extend(repeat_n(y + *dy, xs.len()));
            return;
        }
        for &x in xs {
            self.xs.extend(samples.xs.iter().map(|&dx| x + dx));
            self.ys.extend(samples.ys.iter().map(|&dy| y + dy));
        }
    }

    /// Returns x and y of the positions from index `first` on. Lanes beyond the last position
    /// repeat some of them.
    #[inline(always)]
    pub(crate) fn load<L: Lane<Scalar = S>>(&self, first: usize) -> (L, L) {
        if first + L::LANES <= self.len() {
            return (L::load(&self.xs[first..]), L::load(&self.ys[first..]));
        }
        let filled =
            |numbers: &[S]| L::from_fn(|lane| numbers[first + lane % (numbers.len() - first)]);
        (filled(&self.xs), filled(&self.ys))
    }
}

/// Returns the distance between positions that are `steps` lattice steps apart. It is exact.
#[inline(always)]
pub(crate) fn lattice_distance<S: Scalar>(steps: i64) -> S {
    S::from_f64(2.0 * steps as f64)
}

/// The colours of samples, one list a channel: red, green and blue.
#[derive(Debug, Default)]
pub(crate) struct Colors<S> {
    pub(crate) channels: [Vec<S>; 3],
    /// The path hash of each sample, see [`Traced`]. Empty unless adaptive sampling needs them.
    pub(crate) path_hashes: Vec<u32>,
}

impl<S: Scalar> Colors<S> {
    /// Makes room for `count` samples, and for their path hashes if `path_hashes` is set.
    pub(crate) fn resize(&mut self, count: usize, path_hashes: bool) {
        for channel in &mut self.channels {
            channel.resize(count, S::literal(0.0));
        }
        self.path_hashes.resize(if path_hashes { count } else { 0 }, 0);
    }

    /// Returns the colours of these samples.
    #[inline(always)]
    pub(crate) fn range(&self, samples: Range<usize>) -> impl Iterator<Item = Vector<S>> {
        let [red, green, blue] = self.channels.each_ref().map(|channel| &channel[samples.clone()]);
        red.iter().zip(green).zip(blue).map(|((&red, &green), &blue)| Vector::new(red, green, blue))
    }

    /// Stores the colours and path hashes of a packet from index `first` on.
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
