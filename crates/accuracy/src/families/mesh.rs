//! Families of meshes whose triangles share edges and vertices bit for bit.

use glam::DVec3;

use super::Setup;
use super::draw::{Draw, ray, rounded, single};
use crate::cases::{Primitive, Ray};

/// The placement of a mesh: as drawn, at another scale, or far from the origin.
struct Placement {
    scale: f64,
    offset: DVec3,
}

impl Placement {
    fn draw(draw: &mut Draw, index: usize) -> Self {
        let mut placement = Self { scale: 1.0, offset: DVec3::ZERO };
        match index % 3 {
            0 => {}
            1 => placement.scale = draw.magnitude(1e-3, 1e4),
            _ => placement.offset = draw.unit() * draw.magnitude(1e3, 1e5),
        }
        placement
    }

    /// Returns the placed point, rounded to f32.
    fn put(&self, point: DVec3) -> DVec3 {
        rounded(point * self.scale + self.offset)
    }

    fn note(&self) -> String {
        format!("scale {:.1e} offset {:.1e}", self.scale, self.offset.length())
    }
}

/// Finishes a case, with each triangle starting at a random vertex and turning either way.
fn setup(draw: &mut Draw, mut triangles: Vec<[DVec3; 3]>, ray: Ray, note: String) -> Setup {
    for triangle in &mut triangles {
        triangle.rotate_left(draw.integer(0, 2) as usize);
        if draw.chance(0.5) {
            triangle.swap(1, 2);
        }
    }
    let triangles = triangles.into_iter().map(|triangle| triangle.map(single)).collect();
    Setup { primitive: Primitive::Mesh { triangles }, ray, note }
}

/// The number of tries to find a suitable view. About every second view is suitable.
const TRIES: usize = 100;

pub(super) fn edge(draw: &mut Draw, index: usize) -> Setup {
    let placement = Placement::draw(draw, index);
    let (start, along) = (draw.within(1.5), draw.unit() * draw.range(0.5, 4.0));
    let side = draw.across(along);
    let middle = start + along * draw.range(0.0, 1.0);
    let wings = [1.0, -1.0]
        .map(|way| middle + (side * way + draw.within(0.5)) * draw.range(0.3, 3.0))
        .map(|wing| placement.put(wing));
    let (a, b) = (placement.put(start), placement.put(start + along));
    let target = a + (b - a) * draw.range(0.02, 0.98);
    let mut aim = || target + draw.unit() * draw.range(1.0, 9.0) * placement.scale;
    // The triangles must lie on different sides of the edge, seen from the origin. At a silhouette,
    // where both lie on one side, a ray past the edge is no leak.
    let mut origin = aim();
    for _ in 0..TRIES {
        let [one, other] = wings.map(|wing| (target - origin).dot((b - a).cross(wing - a)));
        if one * other < 0.0 {
            break;
        }
        origin = aim();
    }
    let ray = draw.ray_to(origin, target);
    setup(draw, wings.map(|wing| [a, b, wing]).to_vec(), ray, placement.note())
}

pub(super) fn vertex(draw: &mut Draw, index: usize) -> Setup {
    let placement = Placement::draw(draw, index);
    let sides = draw.integer(3, 8) as usize;
    let mut fan = || {
        let axis = draw.unit();
        let right = draw.across(axis);
        let ahead = axis.cross(right);
        let hub = placement.put(draw.within(0.5));
        let mut rim = |side: usize| {
            let angle =
                (side as f64 + draw.range(-0.3, 0.3)) * std::f64::consts::TAU / sides as f64;
            let spoke = right * libm::cos(angle) + ahead * libm::sin(angle);
            placement.put((spoke + axis * draw.range(-0.3, 0.3)) * draw.range(0.5, 2.0))
        };
        let rim: Vec<DVec3> = (0..sides).map(&mut rim).collect();
        let way = axis * draw.sign() + draw.within(0.5);
        let origin = hub + way * draw.range(3.0, 10.0) * placement.scale;
        (
            origin,
            (0..sides).map(|side| [hub, rim[side], rim[(side + 1) % sides]]).collect::<Vec<_>>(),
        )
    };
    // All triangles must turn the same way, seen from the origin. Where one is folded over, the hub
    // is on the silhouette, and a ray past it is no leak.
    let (mut origin, mut triangles) = fan();
    for _ in 0..TRIES {
        let mut turns =
            triangles.iter().map(|[a, b, c]| (a - origin).dot((b - a).cross(c - a)) > 0.0);
        let first = turns.next();
        if turns.all(|turn| Some(turn) == first) {
            break;
        }
        (origin, triangles) = fan();
    }
    let ray = draw.ray_to(origin, triangles[0][0]);
    setup(draw, triangles, ray, format!("fan of {sides}, {}", placement.note()))
}

pub(super) fn closed(draw: &mut Draw, index: usize) -> Setup {
    let placement = Placement::draw(draw, index);
    let mut tip = |axis: DVec3| placement.put(axis * draw.range(1.0, 4.0) + draw.within(0.4));
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| [tip(axis), tip(-axis)]);
    let octants = (0..8).map(|octant| [x[octant & 1], y[octant >> 1 & 1], z[octant >> 2]]);
    let triangles: Vec<[DVec3; 3]> = octants.collect();
    let [from, to, _] = triangles[index / 3 % 8];
    let along = if draw.chance(0.5) { 0.0 } else { draw.range(0.0, 1.0) };
    let origin = placement.put(draw.within(0.1));
    let direction = from + (to - from) * along - origin;
    let ray = match draw.integer(0, 2) {
        0 => ray(origin, direction),
        1 => ray(origin, direction.normalize()),
        _ => ray(origin, direction * draw.magnitude(1e-7, 1e7)),
    };
    setup(draw, triangles, ray, format!("octahedron, {}", placement.note()))
}
