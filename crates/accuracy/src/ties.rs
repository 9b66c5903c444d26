//! Tie cases: a ray against planes and triangles that lie in one plane, written differently.
//!
//! All that the ray hits are at the same `t`, so the first listed is seen. The numbers are integers
//! times a power of two, so few digits long that the surfaces lie in one plane exactly, however it
//! is tilted. The [`oracle`](crate::oracle) decides which of them the ray hits.

use std::fmt;

use glam::DVec3;
use rayweave_core::Precision;
use rayweave_core::scene::{Camera, Material, Plane, RenderSettings, Scene, Triangle};

use crate::families::draw::Draw;
use crate::oracle::shadow::{ExactOccluder, Occluder};

/// A ray, and surfaces in one plane.
#[derive(Clone, Debug)]
pub struct TieCase {
    /// The scene, whose camera looks along the ray.
    pub scene: Scene,
    /// The start and the direction of the ray.
    pub ray: [DVec3; 2],
    /// The number of the first surface that the ray hits, through planes and triangles.
    pub first: Option<usize>,
    /// The first of [`ERRORS`] that change nothing.
    errors: usize,
}

/// The errors of the ray's ends that are tried, in shares of the largest coordinate: those of
/// `f32`, those of `f64` and none. They are 64 roundings: of the ends, of the corners, and of the
/// sides of the edges.
const ERRORS: [f64; 3] = [32.0 * f32::EPSILON as f64, 32.0 * f64::EPSILON, 0.0];

impl TieCase {
    /// Returns whether a renderer of this precision must get it right.
    #[must_use]
    pub fn is_decidable(&self, precision: Precision) -> bool {
        self.errors <= usize::from(precision == Precision::F64)
    }
}

impl fmt::Display for TieCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, ray, first, .. } = self;
        write!(f, "{first:?} is first\n{ray:?}\n{:#?}\n{:#?}", scene.planes, scene.triangles)
    }
}

/// Returns `count` tie cases. Each depends only on the seed and its index.
#[must_use]
pub fn tie_cases(seed: u64, count: usize) -> Vec<TieCase> {
    (0..count).map(|index| case(&mut Draw::new(seed, "ties", index), index)).collect()
}

/// A plane and the directions in it.
struct Board {
    origin: DVec3,
    sides: [DVec3; 2],
    normal: DVec3,
}

const MATERIAL: usize = 0;

impl Board {
    /// Draws a plane with coordinates of few digits, or of as many as `f32` has. Some planes
    /// are almost level in one axis.
    fn new(draw: &mut Draw) -> Self {
        let steps = if draw.chance(0.5) { 8 } else { 1 << 21 };
        let unit = libm::ldexp(1.0, draw.integer(-8, 8)) * 8.0 / f64::from(steps);
        let origin = draw.lattice(8 * steps, unit);
        loop {
            let mut sides = [draw.lattice(steps, 1.0), draw.lattice(steps, 1.0)];
            if draw.chance(0.5) {
                let axis = draw.integer(0, 2) as usize;
                sides.iter_mut().for_each(|side| side[axis] = f64::from(draw.integer(-1, 1)));
            }
            let normal = sides[0].cross(sides[1]);
            if normal.length() > 0.3 * sides[0].length() * sides[1].length() {
                return Self { origin, sides: sides.map(|side| side * unit), normal };
            }
        }
    }

    fn at(&self, [i, j]: [f64; 2]) -> DVec3 {
        self.origin + self.sides[0] * i + self.sides[1] * j
    }

    fn point(&self, draw: &mut Draw) -> DVec3 {
        self.at([0, 1].map(|_| f64::from(draw.integer(-9, 9))))
    }

    fn plane(&self, draw: &mut Draw) -> Occluder {
        let normal = self.normal * f64::from(draw.integer(1, 7)) * draw.sign();
        Occluder::Plane(Plane { point: self.point(draw), normal, material: MATERIAL })
    }

    fn triangle(&self, draw: &mut Draw) -> [DVec3; 3] {
        loop {
            let corners = [0, 1, 2].map(|_| self.point(draw));
            let [a, b, c] = corners;
            if (b - a).cross(c - a) != DVec3::ZERO {
                return corners;
            }
        }
    }
}

/// Returns the triangle with its corners in another order.
fn turned(draw: &mut Draw, mut corners: [DVec3; 3]) -> [DVec3; 3] {
    corners.rotate_left(draw.integer(1, 2) as usize);
    if draw.chance(0.5) {
        corners.swap(0, 1);
    }
    corners
}

fn case(draw: &mut Draw, index: usize) -> TieCase {
    let board = Board::new(draw);
    let triangle = |vertices| Occluder::Triangle(Triangle { vertices, material: MATERIAL });
    let corners = board.triangle(draw);
    let surfaces = match index % 4 {
        0 => vec![board.plane(draw), board.plane(draw)],
        1 => vec![board.plane(draw), triangle(corners), triangle(board.triangle(draw))],
        2 => vec![triangle(corners), triangle(turned(draw, corners))],
        _ => {
            let mut other = || triangle(board.triangle(draw));
            vec![other(), triangle(corners), other()]
        }
    };
    // Within one triangle or near it.
    let shares = [draw.range(-0.2, 0.8), draw.range(-0.2, 0.8)];
    let [a, b, c] = corners;
    let target = a + (b - a) * shares[0] + (c - a) * shares[1];
    let size = (b - a).length().max((c - a).length());
    let aside = board.sides[0].normalize() * draw.signed_magnitude(1e-3, 1.0);
    let rise = board.normal.normalize() * draw.signed_magnitude(1e-3, 1.0);
    let origin = target + (aside + rise) * size * draw.magnitude(0.1, 10.0);
    let end = origin + (target - origin) * 2.0;

    let hit = |from: DVec3, to: DVec3| -> Option<Vec<bool>> {
        surfaces.iter().map(|surface| ExactOccluder::new(surface, to)?.hides_from(from)).collect()
    };
    let hits = hit(origin, end);
    let vertices = corners.into_iter().chain([origin, end]);
    let reach = vertices.map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let corners = (0..8).map(|i| DVec3::from_array([0, 1, 2].map(|axis| f64::from(i >> axis & 1))));
    let harmless = |error: &f64| {
        corners.clone().map(|corner| (corner * 2.0 - 1.0) * (error * reach)).all(|by| {
            hits.is_some() && hit(origin + by, end) == hits && hit(origin, end + by) == hits
        })
    };
    TieCase {
        scene: scene(&surfaces, origin, target),
        ray: [origin, target - origin],
        first: hits.as_ref().and_then(|hits| hits.iter().position(|&hit| hit)),
        errors: ERRORS.iter().position(harmless).unwrap_or(ERRORS.len()),
    }
}

fn scene(surfaces: &[Occluder], position: DVec3, look_at: DVec3) -> Scene {
    let mut scene = Scene {
        camera: Camera {
            position,
            look_at,
            up: (look_at - position).any_orthogonal_vector(),
            focal_length: 1.0,
            screen_width: 1.0,
        },
        render: RenderSettings::default(),
        lights: Vec::new(),
        materials: vec![Material::new(DVec3::ONE)],
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    };
    for surface in surfaces {
        match *surface {
            Occluder::Plane(plane) => scene.planes.push(plane),
            Occluder::Triangle(triangle) => scene.triangles.push(triangle),
            Occluder::Sphere(sphere) => scene.spheres.push(sphere),
            Occluder::Cylinder(cylinder) => scene.cylinders.push(cylinder),
        }
    }
    scene
}
