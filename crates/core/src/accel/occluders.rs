//! The primitives that may lie between a light and the points it lights.

use super::cones::ConeSet;

/// The primitives that a shadow ray to one light has to try.
#[derive(Clone, Debug)]
pub(crate) struct Occluders<S> {
    /// The planes, by number.
    pub(crate) planes: Vec<u32>,
    /// The direction cones of all other primitives, seen from the light. Without cones a shadow ray
    /// tries each of them.
    pub(crate) cones: Option<ConeSet<S>>,
}
