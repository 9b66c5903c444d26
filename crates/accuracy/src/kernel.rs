//! The tracer's own kernel, asked for its answers.

use crate::cases::{Case, Primitive};
use crate::outcomes::Outcome;
use glam::DVec3;
use rayweave_core::scene::{Camera, Cylinder, Material, Plane, RenderSettings, Scene, Sphere, Triangle};
use rayweave_core::{Arithmetic, Caster, Precision};

/// What the kernel that renders answers to `case`. Input that means nothing, which no scene may
/// contain, is a miss; so is every triangle without area.
#[must_use]
pub fn outcome(case: &Case, arithmetic: Arithmetic) -> Outcome {
    let scene = scene_of(&case.primitive);
    let (origin, direction) = (vector(case.ray.origin), vector(case.ray.direction));
    // A scene that is refused hits nothing.
    let hit = Caster::new(&scene, arithmetic).ok().and_then(|caster| caster.nearest_hit(origin, direction));
    let t = hit.map(|hit| match arithmetic.precision {
        Precision::F32 => f64::from(hit.t as f32),
        Precision::F64 => hit.t,
    });
    Outcome { id: case.id.clone(), hit: hit.is_some(), t }
}

/// A scene of nothing but `primitive`.
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
    let triangle = |corners: [[f32; 3]; 3]| Triangle { vertices: corners.map(vector), material };
    match *primitive {
        Primitive::Plane { point, normal } => {
            scene.planes.push(Plane { point: vector(point), normal: vector(normal), material });
        }
        Primitive::Sphere { center, radius } => {
            scene.spheres.push(Sphere { center: vector(center), radius: radius.into(), material });
        }
        Primitive::Triangle { a, b, c } => scene.triangles.push(triangle([a, b, c])),
        Primitive::Cylinder { bottom, top, radius } => scene.cylinders.push(Cylinder {
            bottom: vector(bottom),
            top: vector(top),
            radius: radius.into(),
            material,
        }),
        Primitive::Mesh { ref triangles } => scene.triangles.extend(triangles.iter().copied().map(triangle)),
    }
    scene.triangles.retain(|triangle| triangle.check().is_ok());
    scene
}

fn vector(components: [f32; 3]) -> DVec3 {
    DVec3::from_array(components.map(f64::from))
}
