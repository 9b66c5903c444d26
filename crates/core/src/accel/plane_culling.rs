//! Culling by planes: no ray crosses a plane, since it ends there.
//!
//! If all rays start at the eye, everything they reach is on the eye's side of every plane, and the
//! space on this side is convex. So a light on the other side lights nothing, and a light on this
//! side is hidden by no plane.
//!
//! That holds for exact points. A computed point may be some roundings behind a plane that it
//! touches, and would then be in the plane's shadow. So this is part of the meaning of the robust
//! formulas, with and without acceleration, and not only an optimisation.

use crate::scene::Scene;
use crate::shapes::MARGIN;
use crate::shapes::side::Side;
use glam::DVec3;

/// Returns the numbers of the planes that may hide a light from what rays from `eye` reach, and the
/// light's sides of them as they are written, or `None` if the light lights nothing of it. Without
/// an `eye`, rays may start anywhere.
pub(crate) fn hiding_planes(
    scene: &Scene,
    light: DVec3,
    eye: Option<DVec3>,
    roundoff: f64,
) -> Option<Vec<(u32, Side)>> {
    let mut hiding = Vec::new();
    // A point is farther from a plane of its known side than any error of a hit.
    let side = |plane, point| Side::of_plane(plane, point, MARGIN * roundoff);
    for (number, plane) in (0..).zip(&scene.planes) {
        let eye_side = eye.map_or(Side::Unknown, |eye| side(plane, eye));
        match (eye_side, side(plane, light)) {
            (Side::Unknown, _) | (_, Side::Unknown) => {
                hiding.push((number, Side::as_written(plane, light)));
            }
            (eye, light) if eye != light => return None,
            _ => {}
        }
    }
    Some(hiding)
}
