//! Two families of formulas for where rays meet shapes, and how rays leave them again.
//!
//! The meaning of a scene, its lighting and the number of bounces are the same for both families.
//! The families differ in their rounding errors and their time, which can so be compared.

mod family;
mod robust;
mod textbook;

pub(crate) use family::{Family, LightPath, RayPrecomputations};

use crate::settings::{Arithmetic, Formulas, Precision};
use crate::simd::lane::Scalar;
use robust::Robust;
use textbook::Textbook;

/// A computation that is compiled for each arithmetic: the number type and the family of formulas
/// are type parameters.
pub(crate) trait Compiled {
    type Output;

    fn compiled<S: Scalar, F: Family>(self) -> Self::Output;
}

/// Runs `what` in this arithmetic. No other place chooses number type and formulas.
pub(crate) fn select<C: Compiled>(arithmetic: Arithmetic, what: C) -> C::Output {
    match (arithmetic.formulas, arithmetic.precision) {
        (Formulas::Robust, Precision::F32) => what.compiled::<f32, Robust>(),
        (Formulas::Robust, Precision::F64) => what.compiled::<f64, Robust>(),
        (Formulas::Textbook, Precision::F32) => what.compiled::<f32, Textbook>(),
        (Formulas::Textbook, Precision::F64) => what.compiled::<f64, Textbook>(),
    }
}
