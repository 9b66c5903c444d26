//! Shadow cases: whether a surface hides a light that lies in it or close to it.
//!
//! A case is a scene of one light, one surface and a plane that the camera looks at. Its image of
//! one pixel tells whether the light reaches the plane, which is decided by exact arithmetic
//! ([`oracle`](crate::oracle)). Half of the lights lie in the surface, the others before or beyond
//! it, down to 10^-12 of its size. The way to the light may graze the surface. So hits, the start
//! of a shadow ray and its end have to be right together.
//!
//! The format of [`cases`](crate::cases) has no place for them: its rays have no end, and its
//! answers are a `t`.

use std::fmt;

use glam::DVec3;
use rayweave_core::Precision;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Scene, Sphere, Triangle,
};

use crate::families::draw::Draw;
use crate::oracle::shadow::{ExactOccluder, Occluder};

/// One light, one surface, and one point that the surface may hide from the light.
#[derive(Clone, Debug)]
pub struct ShadowCase {
    /// The scene. Its image of one pixel is green where the light is seen, black where not, and red
    /// nowhere.
    pub scene: Scene,
    /// True if the light is seen.
    pub lit: bool,
    /// The distance from the point, in roundings of the coordinates, up to which the answer is the
    /// same; one of [`SURE`].
    roundings: f64,
    note: String,
}

/// The errors of the point that are tried, in roundings of the largest coordinate: none, those of
/// `f64` and those of `f32`. A point is seen from the eye up to 20 roundings, moved off its surface
/// by 24, and the surface between it and the light is known to 4.
const SURE: [f64; 3] = [0.0, f64::EPSILON / 2.0 * ROUNDINGS, f32::EPSILON as f64 / 2.0 * ROUNDINGS];
const ROUNDINGS: f64 = 48.0;

impl ShadowCase {
    /// Returns whether a renderer of this precision must get it right.
    #[must_use]
    pub fn is_decidable(&self, precision: Precision) -> bool {
        self.roundings
            >= match precision {
                Precision::F64 => SURE[1],
                Precision::F32 => SURE[2],
            }
    }
}

impl fmt::Display for ShadowCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, lit, note, .. } = self;
        write!(f, "{note}: {}lit\n{scene:#?}", if *lit { "" } else { "not " })
    }
}

/// Returns `count` shadow cases. Each depends only on the seed and its index.
#[must_use]
pub fn shadow_cases(seed: u64, count: usize) -> Vec<ShadowCase> {
    (0..count).map(|index| case(seed, index)).collect()
}

fn case(seed: u64, index: usize) -> ShadowCase {
    let mut draw = Draw::new(seed, "shadows", index);
    loop {
        // About half of the attempts look through the surface or into it.
        if let Some(case) = attempt(&mut draw, index) {
            return case;
        }
    }
}

/// A light, and a surface through, before or beyond it.
struct Setup {
    occluder: Occluder,
    light: DVec3,
    /// The normal of the surface at the light.
    normal: DVec3,
    /// A direction along the surface.
    along: DVec3,
}

fn attempt(draw: &mut Draw, index: usize) -> Option<ShadowCase> {
    let size = draw.magnitude(1e-3, 1e3);
    let gap = if draw.chance(0.5) { 0.0 } else { draw.signed_magnitude(1e-12, 0.1) };
    let place = draw.within(3.0) * size * if draw.chance(0.2) { 100.0 } else { 1.0 };
    let (kind, Setup { occluder, light, normal, along }) = match index % 4 {
        0 => ("plane", plane(draw, size, place, gap)),
        1 => ("triangle", triangle(draw, size, place, gap)),
        2 => ("sphere", sphere(draw, size, place, gap)),
        _ => ("cylinder", cylinder(draw, size, place, gap)),
    };
    let rise = draw.signed_magnitude(1e-6, 1.0);
    let distance = size * draw.range(0.3, 4.0);
    let point = light + (along + normal * rise).normalize() * distance;
    let facing = ((light - point).normalize() + draw.within(0.4)).normalize();
    let eye = point + (facing + draw.within(0.3)) * distance * draw.range(0.1, 0.5);

    let exact = ExactOccluder::new(&occluder, light)?;
    let from_eye = ExactOccluder::new(&occluder, eye)?;
    let hidden = exact.hides_from(point)?;
    if from_eye.hides_from(point)? {
        return None;
    }
    let reach = [point, light, eye, place].map(|v| v.abs().max_element());
    let reach = reach.into_iter().fold(size, f64::max);
    let corners = (0..8).map(|i| DVec3::from_array([0, 1, 2].map(|axis| f64::from(i >> axis & 1))));
    let roundings = SURE.into_iter().rev().find(|error| {
        corners.clone().all(|corner| {
            let moved = point + (corner * 2.0 - 1.0) * (error * reach);
            exact.hides_from(moved) == Some(hidden) && from_eye.hides_from(moved) == Some(false)
        })
    })?;
    // Enough primitives for a hierarchy of boxes, behind the plane that is seen.
    let others = if index / 4 % 4 == 3 { 64 } else { 0 };
    let hidden_sphere = |i: i32| Sphere {
        center: point - facing * (distance * (1.0 + 0.1 * f64::from(i))),
        radius: distance * 0.2,
        material: SURFACE,
    };
    let target = Plane { point, normal: facing, material: TARGET };
    let mut scene = scene(eye, point, facing, light);
    scene.planes.push(target);
    scene.spheres.extend((0..others).map(hidden_sphere));
    match occluder {
        Occluder::Plane(plane) => scene.planes.insert(index / 4 % 2, plane),
        Occluder::Sphere(sphere) => scene.spheres.push(sphere),
        Occluder::Triangle(triangle) => scene.triangles.push(triangle),
        Occluder::Cylinder(cylinder) => scene.cylinders.push(cylinder),
    }
    let note = format!("{kind} {index}, gap {gap:.1e}, rise {rise:.1e}, size {size:.1e}");
    Some(ShadowCase { scene, lit: !hidden, roundings, note })
}

const SURFACE: usize = 0;
const TARGET: usize = 1;

fn scene(eye: DVec3, look_at: DVec3, facing: DVec3, light: DVec3) -> Scene {
    let matte = Material { ambient: 0.0, diffuse: 1.0, specular: 0.0, ..Material::new(DVec3::Y) };
    let glowing = Material { ambient: 1.0, diffuse: 0.0, ..Material { color: DVec3::X, ..matte } };
    Scene {
        camera: Camera {
            position: eye,
            look_at,
            up: facing.any_orthogonal_vector(),
            focal_length: 1.0,
            screen_width: 1.0,
        },
        render: RenderSettings { antialiasing: 0, ..RenderSettings::default() },
        lights: vec![Light { position: light, color: DVec3::ONE, power: 1.0 }],
        materials: vec![glowing, matte],
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    }
}

/// Draws the normal of a level or upright surface in some cases, else any normal.
fn direction(draw: &mut Draw) -> DVec3 {
    if draw.chance(0.3) {
        DVec3::AXES[draw.integer(0, 2) as usize] * draw.sign()
    } else {
        draw.unit()
    }
}

fn plane(draw: &mut Draw, size: f64, point: DVec3, gap: f64) -> Setup {
    let normal = direction(draw);
    let (along, to_light) = (draw.across(normal), draw.across(normal));
    let light = point + to_light * size * draw.range(0.0, 3.0) + normal * (gap * size);
    let scaled = normal * draw.magnitude(0.01, 100.0);
    let plane = Plane { point, normal: scaled, material: SURFACE };
    Setup { occluder: Occluder::Plane(plane), light, normal, along }
}

fn triangle(draw: &mut Draw, size: f64, place: DVec3, gap: f64) -> Setup {
    let normal = direction(draw);
    let along = draw.across(normal);
    let other = normal.cross(along);
    // Some lights are in the plane, but beside the triangle.
    let middle = if draw.chance(0.2) { along * draw.range(-4.0, 4.0) } else { DVec3::ZERO };
    let first = draw.range(0.0, 2.0);
    let vertices = [0.0, 2.1, 4.2].map(|turn| {
        let angle = first + turn;
        let outward = along * libm::cos(angle) + other * libm::sin(angle);
        place + (middle + outward * draw.magnitude(0.1, 3.0)) * size
    });
    let triangle = Triangle { vertices, material: SURFACE };
    let light = place + normal * (gap * size);
    Setup { occluder: Occluder::Triangle(triangle), light, normal, along }
}

fn sphere(draw: &mut Draw, size: f64, center: DVec3, gap: f64) -> Setup {
    let (normal, radius) = (direction(draw), size * draw.magnitude(0.1, 10.0));
    let light = center + normal * (radius + gap * radius);
    let sphere = Sphere { center, radius, material: SURFACE };
    Setup { occluder: Occluder::Sphere(sphere), light, normal, along: draw.across(normal) }
}

fn cylinder(draw: &mut Draw, size: f64, bottom: DVec3, gap: f64) -> Setup {
    let circle = draw.circle();
    let normal = if draw.chance(0.3) { DVec3::X } else { DVec3::new(circle.x, 0.0, circle.y) };
    let (radius, height) = (size * draw.magnitude(0.1, 10.0), size * draw.range(1.0, 5.0));
    let level = DVec3::Y * (height * draw.range(-0.2, 1.2));
    let top = bottom + DVec3::Y * height;
    let cylinder = Cylinder { bottom, top, radius, material: SURFACE };
    let light = bottom + level + normal * (radius + gap * radius);
    Setup { occluder: Occluder::Cylinder(cylinder), light, normal, along: draw.across(normal) }
}
