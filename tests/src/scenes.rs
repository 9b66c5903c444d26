//! The scenes of the repository, and short ways to build others.

use crate::model::Primitive;
use glam::DVec3;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};
use rayweave_core::{Arithmetic, Caster, Precision, Scene};
use std::fs;
use std::path::{Path, PathBuf};

/// Both precisions.
pub const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

/// The names of the scenes in `scenes`: those of the files, without the ending.
pub const NAMES: [&str; 3] = ["lab", "room", "imbalance"];

/// Reads the scene of this name; that of a hard one is `hard/fan`.
///
/// # Panics
///
/// If there is no such file, or it is not sound.
#[must_use]
pub fn named(name: &str) -> Scene {
    rayweave_scene_file::load(&folder().join(format!("{name}.toml")))
        .expect("a sound scene file")
        .scene
}

/// Lists the names of the scenes in `scenes/hard`, sorted.
///
/// # Panics
///
/// If the folder cannot be read or has something else in it.
#[must_use]
pub fn hard() -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| {
        let file = entry.expect("an entry").file_name().into_string().expect("a plain name");
        file.strip_suffix(".toml").expect("a scene file").to_owned()
    };
    let mut names: Vec<_> =
        fs::read_dir(folder().join("hard")).expect("a folder").map(name).collect();
    names.sort();
    names
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes")
}

/// A scene without primitives, whose only material is red with the model's defaults.
#[must_use]
pub fn looking(from: DVec3, at: DVec3, lights: &[DVec3]) -> Scene {
    Scene {
        camera: Camera {
            position: from,
            look_at: at,
            up: DVec3::Y,
            focal_length: 1.0,
            screen_width: 1.0,
        },
        render: RenderSettings { antialiasing: 0, ..RenderSettings::default() },
        lights: lights.iter().copied().map(light).collect(),
        materials: vec![Material::new(DVec3::X)],
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    }
}

/// A scene without primitives under one light, seen from the lab report's eye.
#[must_use]
pub fn empty() -> Scene {
    let at = DVec3::new(11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0);
    looking(-2.0 * DVec3::Z, at, &[DVec3::new(15.0, -10.0, -10.0)])
}

/// A scene of these primitives alone, in the order of the model.
#[must_use]
pub fn of(primitives: impl IntoIterator<Item = Primitive>) -> Scene {
    with(empty(), primitives)
}

/// Appends primitives to a scene.
#[must_use]
pub fn with(mut scene: Scene, primitives: impl IntoIterator<Item = Primitive>) -> Scene {
    for primitive in primitives {
        match primitive {
            Primitive::Plane(plane) => scene.planes.push(plane),
            Primitive::Sphere(sphere) => scene.spheres.push(sphere),
            Primitive::Triangle(triangle) => scene.triangles.push(triangle),
            Primitive::Cylinder(cylinder) => scene.cylinders.push(cylinder),
        }
    }
    scene
}

/// A white light of power 1.
#[must_use]
pub const fn light(position: DVec3) -> Light {
    Light { position, color: DVec3::ONE, power: 1.0 }
}

/// A plane of material 0.
#[must_use]
pub const fn plane(point: DVec3, normal: DVec3) -> Primitive {
    Primitive::Plane(Plane { point, normal, material: 0 })
}

/// A sphere of material 0.
#[must_use]
pub const fn sphere(center: DVec3, radius: f64) -> Primitive {
    Primitive::Sphere(Sphere { center, radius, material: 0 })
}

/// A triangle of material 0.
#[must_use]
pub const fn triangle(vertices: [DVec3; 3]) -> Primitive {
    Primitive::Triangle(Triangle { vertices, material: 0 })
}

/// A cylinder of material 0.
#[must_use]
pub const fn cylinder(bottom: DVec3, height: f64, radius: f64) -> Primitive {
    let top = DVec3::new(bottom.x, bottom.y + height, bottom.z);
    Primitive::Cylinder(Cylinder { bottom, top, radius, material: 0 })
}

/// Prepares a scene for single rays.
///
/// # Panics
///
/// If the scene is not sound.
#[must_use]
pub fn caster(scene: &Scene, arithmetic: impl Into<Arithmetic>) -> Caster {
    Caster::new(&scene.with_arithmetic(arithmetic)).expect("a sound scene")
}
