//! The answers and the speed of the tracer's own kernel on hard cases.

use crate::cases::{HardCase, Primitive, double};
use crate::outcomes::Outcome;
use glam::DVec3;
use rayweave_core::scene::{
    Camera, Cylinder, Material, Plane, RenderSettings, Scene, Sphere, Triangle,
};
use rayweave_core::{Arithmetic, Caster, Precision};
use rayweave_measure::statistics::median;
use std::hint::black_box;
use std::time::Instant;

/// A case prepared for repeated runs of the kernel.
pub struct Prepared {
    id: String,
    /// `None` for a meaningless primitive, which is never hit.
    caster: Option<Caster>,
    origin: DVec3,
    direction: DVec3,
    precision: Precision,
}

impl Prepared {
    /// Prepares `case`. Meaningless input, which no scene may contain, is a miss; so is every
    /// triangle without area.
    #[must_use]
    pub fn new(case: &HardCase, arithmetic: Arithmetic) -> Self {
        Self {
            id: case.id.clone(),
            caster: Caster::new(&scene_of(&case.primitive).with_arithmetic(arithmetic)).ok(),
            origin: double(case.ray.origin),
            direction: double(case.ray.direction),
            precision: arithmetic.precision,
        }
    }

    /// Returns the `t` of the closest hit that the kernel finds, in its precision.
    #[must_use]
    pub fn hit(&self) -> Option<f64> {
        let hit = self.caster.as_ref()?.closest_hit(self.origin, self.direction)?;
        Some(match self.precision {
            Precision::F32 => f64::from(hit.t as f32),
            Precision::F64 => hit.t,
        })
    }

    /// Returns the answer of the kernel.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let t = self.hit();
        Outcome { id: self.id.clone(), hit: t.is_some(), t }
    }
}

/// Returns the answer of the kernel to `case`.
#[must_use]
pub fn outcome(case: &HardCase, arithmetic: Arithmetic) -> Outcome {
    Prepared::new(case, arithmetic).outcome()
}

/// The number of passes over the cases; the median counts.
const PASSES: usize = 9;

/// The minimum number of rays per pass, which take some tenths of a millisecond.
const RAYS: usize = 4000;

/// Measures the time of a ray in nanoseconds, from origin and direction to the point and the normal
/// of the hit, including the call; `None` without cases. Rays are traced singly; a packet may be
/// faster.
#[must_use]
pub fn nanoseconds_per_ray(cases: &[&Prepared]) -> Option<f64> {
    if cases.is_empty() {
        return None;
    }
    let repeats = RAYS.div_ceil(cases.len());
    let pass = || {
        let begin = Instant::now();
        for case in (0..repeats).flat_map(|_| cases) {
            black_box(black_box(case).hit());
        }
        begin.elapsed().as_nanos() as f64 / (repeats * cases.len()) as f64
    };
    median(&std::iter::repeat_with(pass).take(PASSES).collect::<Vec<_>>())
}

/// Returns a scene that contains only `primitive`.
fn scene_of(primitive: &Primitive) -> Scene {
    let mut scene = Scene {
        camera: Camera {
            position: DVec3::Z,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
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
    let material = 0;
    let triangle = |corners: [[f32; 3]; 3]| Triangle { vertices: corners.map(double), material };
    match *primitive {
        Primitive::Plane { point, normal } => {
            scene.planes.push(Plane { point: double(point), normal: double(normal), material });
        }
        Primitive::Sphere { center, radius } => {
            scene.spheres.push(Sphere { center: double(center), radius: radius.into(), material });
        }
        Primitive::Triangle { a, b, c } => scene.triangles.push(triangle([a, b, c])),
        Primitive::Cylinder { bottom, top, radius } => scene.cylinders.push(Cylinder {
            bottom: double(bottom),
            top: double(top),
            radius: radius.into(),
            material,
        }),
        Primitive::Mesh { ref triangles } => {
            scene.triangles.extend(triangles.iter().copied().map(triangle));
        }
    }
    scene.triangles.retain(|triangle| triangle.check().is_ok());
    scene
}
