//! What planes keep apart: no ray crosses one, since it ends there.
//!
//! So if all rays start at the eye, everything they ever reach is on the eye's side of every plane.
//! A light on the other side lights nothing, and one on this side is hidden by no plane, since what
//! is on one side is convex.
//!
//! That holds for points. A computed point may be some roundings behind a plane that it is next to,
//! and would then be in its shadow: so this is not only a saving but part of what the robust
//! formulas mean, in every search.

use crate::scene::{Plane, Scene, unit};
use crate::shapes::MARGIN;
use glam::DVec3;

/// On which side of a plane something is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Front,
    Back,
    /// Too near to tell, given rounding.
    Unknown,
}

/// The planes, by number, that may hide a light from what rays from `eye` reach; none if the light
/// lights nothing of that. Without an `eye`, rays may start anywhere.
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

/// As far from the plane as no error of a hit reaches.
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
