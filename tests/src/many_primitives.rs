//! Scenes of any number of primitives, drawn by seed, in arrangements that are hard for a BVH.

use crate::draw::Draw;
use crate::{meshes, scenes};
use glam::DVec3;
use rayweave_core::Scene;
use rayweave_core::scene::{Camera, Cylinder, Light, Material, RenderSettings, Sphere, Triangle};

/// The kinds of primitives in a scene of many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Spheres.
    Sphere,
    /// Triangles: stout ones, slivers, needles, and some that lie across an axis.
    Triangle,
    /// Cylinders.
    Cylinder,
    /// All three kinds.
    Any,
}

impl Shape {
    /// All shapes.
    pub const ALL: [Self; 4] = [Self::Sphere, Self::Triangle, Self::Cylinder, Self::Any];
}

/// The places and sizes of many primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// Anywhere, small.
    Spread,
    /// Gathered in a few narrow places.
    Clusters,
    /// Each reaches into most others.
    Overlapping,
    /// From a thousandth to ten times as large as others.
    Sizes,
    /// Each several times in the very same place, the materials mixed: which is first decides.
    Copies,
    /// On a grid of whole numbers, of one size, touching: boxes that end where others begin.
    Grid,
    /// Centred in the plane y = 0, in which the camera stands.
    Sheet,
    /// Centred in one point: no box tells them apart.
    Nested,
}

impl Arrangement {
    /// All arrangements.
    pub const ALL: [Self; 8] = [
        Self::Spread,
        Self::Clusters,
        Self::Overlapping,
        Self::Sizes,
        Self::Copies,
        Self::Grid,
        Self::Sheet,
        Self::Nested,
    ];
}

/// Draws the scene of this number: `count` primitives within about 6 of the origin under one or
/// two lights, some of them mirrors. The camera is beside them or among them. Some scenes have a
/// plane as well.
#[must_use]
pub fn many_primitives(seed: u64, count: usize, shape: Shape, arrangement: Arrangement) -> Scene {
    let mut draw = Draw::new(seed);
    let mut scene = surroundings(&mut draw, arrangement);
    let places: Vec<DVec3> = (0..20).map(|_| draw.within(5.0)).collect();
    let side = (count as f64).cbrt().ceil();
    // Any number of them fills the space to about the same extent.
    let small = 6.0 / side;
    while bounded(&scene) < count {
        let (place, size) = match arrangement {
            Arrangement::Spread => (draw.within(6.0), small * draw.between(0.2, 1.0)),
            Arrangement::Clusters => {
                let place = places[draw.index(places.len())];
                (place + draw.within(0.1), 0.3 * small * draw.between(0.2, 1.0))
            }
            Arrangement::Overlapping => (draw.within(3.0), draw.between(1.0, 3.0)),
            Arrangement::Sizes => (draw.within(6.0), small * draw.magnitude(1e-2, 10.0)),
            Arrangement::Copies => (draw.within(5.0), 2.0 * small * draw.between(0.3, 1.0)),
            Arrangement::Grid => {
                let cell = bounded(&scene) as f64;
                let (x, y, z) =
                    (cell % side, (cell / side).floor() % side, (cell / side / side).floor());
                (DVec3::new(x, y, z) - (side / 2.0).floor(), 0.5)
            }
            Arrangement::Sheet => {
                (draw.within(6.0) * DVec3::new(1.0, 0.0, 1.0), small * draw.between(0.1, 0.5))
            }
            Arrangement::Nested => (DVec3::ONE, draw.magnitude(0.1, 5.0)),
        };
        let any = if shape == Shape::Any { draw.index(3) } else { shape as usize };
        let material = draw.index(scene.materials.len());
        let copies = arrangement == Arrangement::Copies && draw.chance(0.7);
        match any {
            0 => add(&mut draw, &mut scene.spheres, copies, |draw, original| match original {
                Some(sphere) => Sphere { material, ..sphere },
                None => Sphere { center: place, radius: size * draw.between(0.9, 1.0), material },
            }),
            1 => add(&mut draw, &mut scene.triangles, copies, |draw, original| match original {
                Some(triangle) => Triangle { material, ..triangle },
                None => Triangle { vertices: corners(draw, place, size), material },
            }),
            _ => add(&mut draw, &mut scene.cylinders, copies, |draw, original| match original {
                Some(cylinder) => Cylinder { material, ..cylinder },
                None => {
                    let half = DVec3::Y * size * draw.magnitude(0.2, 4.0);
                    Cylinder {
                        bottom: place - half,
                        top: place + half,
                        radius: 0.5 * size,
                        material,
                    }
                }
            }),
        }
    }
    scene
}

/// Draws `count` closed meshes anywhere and of any size, some within others. The camera looks
/// along an axis from a corner's height, or from anywhere.
#[must_use]
pub fn meshes(seed: u64, count: usize) -> Scene {
    let mut draw = Draw::new(seed);
    let mut scene = surroundings(&mut draw, Arrangement::Spread);
    let kinds = meshes::all();
    for _ in 0..count {
        let (_, mesh) = &kinds[draw.index(kinds.len())];
        let (size, material) = (draw.magnitude(0.2, 2.0), draw.index(scene.materials.len()));
        let place = if draw.chance(0.5) { draw.within(4.0).round() } else { draw.within(4.0) };
        scene.triangles.extend(
            mesh.iter()
                .map(|corners| Triangle { vertices: corners.map(|c| place + size * c), material }),
        );
    }
    scene
}

/// The number of primitives that are not planes.
fn bounded(scene: &Scene) -> usize {
    scene.spheres.len() + scene.triangles.len() + scene.cylinders.len()
}

/// Appends a new entry, made of an old one if it is to be a copy.
fn add<T: Copy>(
    draw: &mut Draw,
    list: &mut Vec<T>,
    copy: bool,
    one: impl FnOnce(&mut Draw, Option<T>) -> T,
) {
    let original = (copy && !list.is_empty()).then(|| list[draw.index(list.len())]);
    list.push(one(draw, original));
}

/// The corners of a triangle around `place`.
fn corners(draw: &mut Draw, place: DVec3, size: f64) -> [DVec3; 3] {
    let direction = draw.direction();
    let (right, up) = direction.any_orthonormal_pair();
    match draw.integer(0..=4) {
        // A sliver: two corners next to each other.
        0 => {
            let far = place + size * direction;
            [place - size * direction, far, far + size * draw.magnitude(1e-6, 1e-2) * right]
        }
        // A needle: the third corner next to the longest edge.
        1 => {
            let aside = draw.magnitude(1e-6, 1e-2) * right + draw.between(-0.9, 0.9) * direction;
            [place - size * direction, place + size * direction, place + size * aside]
        }
        // Across an axis: its box has no thickness.
        2 => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            let axis = draw.index(3);
            let (right, up) = (axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
            [place - size * right, place + size * right, place + size * up]
        }
        _ => [place - size * right, place + size * right, place + size * (up + direction)],
    }
}

/// A scene of a camera, lights, materials, and sometimes a plane.
fn surroundings(draw: &mut Draw, arrangement: Arrangement) -> Scene {
    let material = |draw: &mut Draw| Material {
        specular: 0.5,
        shininess: 8,
        reflection: if draw.chance(0.3) { draw.between(0.2, 1.0) } else { 0.0 },
        ..Material::new(draw.color())
    };
    let away = if draw.chance(0.5) { 3.0 } else { 12.0 };
    let (position, look_at) = match (arrangement, draw.chance(0.5)) {
        (Arrangement::Sheet, true) => (DVec3::new(-away, 0.0, 0.25), DVec3::new(0.0, 0.0, 0.25)),
        // Rays along the axes and the grid.
        (_, true) => (DVec3::new(0.5, 1.0, away), DVec3::new(0.5, 1.0, 0.0)),
        (_, false) => (draw.direction() * away, draw.within(1.0)),
    };
    let camera = Camera {
        position,
        look_at,
        up: DVec3::new(0.1, 1.0, 0.0),
        focal_length: 1.0,
        screen_width: 1.2,
    };
    let light = |draw: &mut Draw| {
        let position = if draw.chance(0.5) { draw.within(4.0) } else { draw.direction() * 15.0 };
        Light { power: 0.8, ..scenes::light(position) }
    };
    let mut scene = Scene {
        camera,
        render: RenderSettings {
            background: DVec3::new(0.1, 0.2, 0.4),
            max_reflections: 3,
            antialiasing: 0,
            ..RenderSettings::default()
        },
        lights: vec![light(draw)],
        materials: (0..7).map(|_| material(draw)).collect(),
        ..scenes::empty()
    };
    if draw.chance(0.5) {
        scene.lights.push(light(draw));
    }
    if draw.chance(0.3) {
        let plane = scenes::plane(-7.0 * DVec3::Y, DVec3::Y).of(draw.index(7));
        scene = scenes::with(scene, [plane]);
    }
    scene
}
