//! Closed meshes around the origin. A point within 5/8 of it is well inside of each.

use crate::scenes;
use glam::DVec3;
use rayweave_core::Scene;

/// Triangles that share their corners, bit for bit.
pub type Mesh = Vec<[DVec3; 3]>;

/// Lists all meshes, each with its name.
#[must_use]
pub fn all() -> [(&'static str, Mesh); 4] {
    [("cube", cube()), ("icosahedron", icosahedron()), ("cone", cone(40)), ("globe", globe())]
}

/// A scene of this mesh alone.
#[must_use]
pub fn scene_of(mesh: &[[DVec3; 3]]) -> Scene {
    scenes::of(mesh.iter().copied().map(scenes::triangle))
}

/// A cube of twelve triangles, whose corners are exact.
#[must_use]
pub fn cube() -> Mesh {
    let mut triangles = Vec::new();
    for (normal, side) in [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X)] {
        for normal in [normal, -normal] {
            let up = normal.cross(side);
            let corner = |right: f64, above: f64| normal + right * side + above * up;
            let [a, b, c, d] =
                [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

/// An icosahedron: twenty triangles, five at each corner, whose corners are not exact.
#[must_use]
pub fn icosahedron() -> Mesh {
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    let mut corners = Vec::new();
    for (long, short) in [(golden, 1.0), (golden, -1.0), (-golden, 1.0), (-golden, -1.0)] {
        corners.extend([
            DVec3::new(0.0, short, long),
            DVec3::new(short, long, 0.0),
            DVec3::new(long, 0.0, short),
        ]);
    }
    // All edges are 2 long, the next longer distance is more than 3.
    let neighbours = |a: DVec3, b: DVec3| (a.distance(b) - 2.0).abs() < 0.1;
    let mut triangles = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        for (j, &b) in corners.iter().enumerate().skip(i + 1) {
            let rest = corners.iter().skip(j + 1);
            let thirds =
                rest.filter(|&&c| neighbours(a, b) && neighbours(b, c) && neighbours(c, a));
            triangles.extend(thirds.map(|&c| [a, b, c]));
        }
    }
    triangles
}

/// A cone of `sides` sides with its base: many triangles meet in two corners.
#[must_use]
pub fn cone(sides: u32) -> Mesh {
    let corner = |k: u32| {
        let (sin, cos) =
            libm::sincos(std::f64::consts::TAU * f64::from(k % sides) / f64::from(sides));
        DVec3::new(2.0 * cos, -1.0, 2.0 * sin)
    };
    let (tip, middle) = (2.0 * DVec3::Y, -DVec3::Y);
    (0..sides).flat_map(|k| [tip, middle].map(|end| [end, corner(k), corner(k + 1)])).collect()
}

/// Almost a sphere: the triangles of the icosahedron in four, and in four again, which makes 320.
#[must_use]
pub fn globe() -> Mesh {
    let radius = icosahedron()[0][0].length();
    // The same from both sides of an edge: no operation knows which corner came first.
    let between = |p: DVec3, q: DVec3| (p + q) * (radius / (p + q).length());
    let in_four = |[a, b, c]: [DVec3; 3]| {
        let [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    icosahedron().into_iter().flat_map(in_four).flat_map(in_four).collect()
}
