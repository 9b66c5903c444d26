//! Acceleration: finds the primitives that a ray may hit, and skips those that it cannot.

pub(crate) mod behind_culling;
pub(crate) mod bounding_sphere;
pub(crate) mod bvh;
mod coincident;
pub(crate) mod cones;
pub(crate) mod hit;
pub(crate) mod occluders;
mod occlusion;
pub(crate) mod plane_culling;
pub(crate) mod primitives;
