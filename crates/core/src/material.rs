//! Materials and lights in the precision of the image, and the powers of Phong's highlight.
//!
//! The model is that of Bui Tuong Phong (Illumination for Computer Generated Pictures, 1975).

use crate::accel::occluders::Occluders;
use crate::scene;
use crate::shapes::ROUNDINGS;
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

/// A material in the precision of the image; see [`scene::Material`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material<S> {
    pub(crate) color: Vector<S>,
    pub(crate) ambient: S,
    pub(crate) diffuse: S,
    pub(crate) specular: S,
    pub(crate) shininess: u32,
    pub(crate) reflection: S,
}

/// A point light in the precision of the image.
#[derive(Clone, Debug)]
pub(crate) struct Light<S> {
    pub(crate) position: Vector<S>,
    /// The rounding error of each coordinate of the position, as part of the error of its height
    /// above a surface. Only for a light in a flat surface, which it does not light.
    pub(crate) uncertain: Option<Vector<S>>,
    /// The colour times the power.
    pub(crate) intensity: Vector<S>,
    /// The primitives that may hide the light.
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
    pub(crate) fn new(
        light: &scene::Light,
        in_flat_surface: bool,
        occluders: Occluders<S>,
    ) -> Self {
        let position = Vector::rounded(light.position);
        let uncertain = position.abs() * S::from_f64(ROUNDINGS * S::ROUNDOFF);
        Self {
            position,
            uncertain: in_flat_surface.then_some(uncertain),
            intensity: Vector::rounded(light.color * light.power),
            occluders,
        }
    }
}

/// The material of the surface under each lane.
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

/// Returns `base ^ exponent` in the lanes of `wanted`, for exponents of 1 or more.
///
/// The order of squarings and multiplications depends on the exponent alone, so that every lane
/// gets the bits that it would get alone.
#[inline(always)]
pub(crate) fn power<L: Lane>(base: L, exponents: L::Index, wanted: L::Mask) -> L {
    let mut result = base;
    let mut todo = wanted;
    // A packet sees few materials, so each distinct exponent is computed once for all lanes that
    // have it.
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
