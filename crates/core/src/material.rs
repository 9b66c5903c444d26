//! Surfaces and lights in the precision of the picture, and Phong's model of how one answers the
//! other (Bui Tuong Phong, Illumination for Computer Generated Pictures, 1975).

use crate::accel::occluders::Occluders;
use crate::scene;
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Material<S> {
    pub(crate) color: Vector<S>,
    pub(crate) ambient: S,
    pub(crate) diffuse: S,
    pub(crate) specular: S,
    pub(crate) shininess: u32,
    pub(crate) reflection: S,
}

#[derive(Clone, Debug)]
pub(crate) struct Light<S> {
    pub(crate) position: Vector<S>,
    /// The sum of the magnitudes of its coordinates: rounding errors near it are in proportion.
    pub(crate) reach: S,
    /// Colour times power.
    pub(crate) intensity: Vector<S>,
    /// The primitives that may hide it.
    pub(crate) occluders: Occluders<S>,
}

impl<S: Scalar> Material<S> {
    pub(crate) fn new(material: &scene::Material) -> Self {
        Self {
            color: Vector::rounded(material.color),
            ambient: S::from_f64(material.ambient),
            diffuse: S::from_f64(material.diffuse),
            specular: S::from_f64(material.specular),
            shininess: material.shininess,
            reflection: S::from_f64(material.reflection),
        }
    }
}

impl<S: Scalar> Light<S> {
    pub(crate) fn new(light: &scene::Light, occluders: Occluders<S>) -> Self {
        let position = Vector::rounded(light.position);
        Self {
            position,
            reach: position.sum_of_magnitudes(),
            intensity: Vector::rounded(light.color * light.power),
            occluders,
        }
    }
}

/// The material under each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish<L: Lane> {
    pub(crate) color: Vector<L>,
    pub(crate) ambient: L,
    pub(crate) diffuse: L,
    pub(crate) specular: L,
    pub(crate) shininess: L::Index,
    pub(crate) reflection: L,
}

impl<L: Lane> Finish<L> {
    #[inline(always)]
    pub(crate) fn splat(material: &Material<L::Scalar>) -> Self {
        Self {
            color: Vector::splat(material.color),
            ambient: L::splat(material.ambient),
            diffuse: L::splat(material.diffuse),
            specular: L::splat(material.specular),
            shininess: L::splat_index(material.shininess),
            reflection: L::splat(material.reflection),
        }
    }

    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            color: Vector::select(mask, yes.color, no.color),
            ambient: L::select(mask, yes.ambient, no.ambient),
            diffuse: L::select(mask, yes.diffuse, no.diffuse),
            specular: L::select(mask, yes.specular, no.specular),
            shininess: L::select_index(mask, yes.shininess, no.shininess),
            reflection: L::select(mask, yes.reflection, no.reflection),
        }
    }
}

/// `base ^ exponent` in the lanes of `wanted`, each exponent 1 or more: squarings and
/// multiplications in an order that only the exponent decides.
#[inline(always)]
pub(crate) fn power<L: Lane>(base: L, exponents: L::Index, wanted: L::Mask) -> L {
    let mut result = base;
    let mut todo = wanted;
    // A packet sees few materials: each distinct exponent is served once, in all lanes that have
    // it.
    while let Some(exponent) = L::first_index(todo, exponents) {
        let here = L::index_equals(exponents, exponent);
        result = L::select(here, power_of_all(base, exponent), result);
        todo = todo & !here;
    }
    result
}

#[inline(always)]
fn power_of_all<L: Lane>(base: L, exponent: u32) -> L {
    let mut result = base;
    // From the second highest bit down.
    for bit in (0..exponent.ilog2()).rev() {
        result = result * result;
        if exponent >> bit & 1 == 1 {
            result = result * base;
        }
    }
    result
}
