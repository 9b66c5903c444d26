//! Culling by planes: no ray crosses a plane, since it ends there.
//!
//! If all rays start at the eye, everything they reach is on the eye's side of every plane, and the
//! space on this side is convex. So a light on the other side lights nothing, and a light on this
//! side is hidden by no plane.
//!
//! That holds for exact points. A computed point may be some roundings behind a plane that it
//! touches, and would then be in the plane's shadow. So this is part of the meaning of the robust
//! formulas, with and without acceleration, and not only an optimisation.

use crate::scene::{Plane, Scene, unit};
use crate::shapes::MARGIN;
use glam::DVec3;

/// The side of a plane that a point is on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Front,
    Back,
    /// Too near to the plane to tell, given rounding.
    Unknown,
}

/// Returns the numbers of the planes that may hide a light from what rays from `eye` reach, or
/// `None` if the light lights nothing of it. Without an `eye`, rays may start anywhere.
pub(crate) fn hiding_planes(
    scene: &Scene,
    light: DVec3,
    eye: Option<DVec3>,
    roundoff: f64,
) -> Option<Vec<u32>> {
    let mut hiding = Vec::new();
    for (number, plane) in (0..).zip(&scene.planes) {
        let eye_side = eye.map_or(Side::Unknown, |eye| side(plane, eye, roundoff));
        match (eye_side, side(plane, light, roundoff)) {
            (Side::Unknown, _) | (_, Side::Unknown) => hiding.push(number),
            (eye, light) if eye != light => return None,
            _ => {}
        }
    }
    Some(hiding)
}

/// Returns the side of a point that is farther from the plane than any error of a hit.
fn side(plane: &Plane, point: DVec3, roundoff: f64) -> Side {
    let normal = unit(plane.normal);
    let height = normal.dot(point - plane.point);
    let margin = MARGIN * roundoff * normal.abs().dot(point.abs() + plane.point.abs());
    if height > margin {
        Side::Front
    } else if height < -margin {
        Side::Back
    } else {
        Side::Unknown
    }
}
