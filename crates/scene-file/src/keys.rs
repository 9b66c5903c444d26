//! The keys of each table and entry: their types, which are required, and what the others default
//! to.

use glam::DVec3;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};

use crate::error::Result;
use crate::material_refs::MaterialRefs;
use crate::mesh::Mesh;
use crate::node::Node;
use crate::scene_file::ImageSize;

pub(crate) fn image(node: &Node) -> Result<ImageSize> {
    node.allow(&["width", "height"])?;
    let default = ImageSize::default();
    let size = ImageSize {
        width: node.optional("width", default.width)?,
        height: node.optional("height", default.height)?,
    };
    node.checked(size, ImageSize::check)
}

pub(crate) fn camera(node: &Node) -> Result<Camera> {
    node.allow(&["position", "look_at", "up", "focal_length", "screen_width"])?;
    let camera = Camera {
        position: node.require("position")?,
        look_at: node.require("look_at")?,
        up: node.require("up")?,
        focal_length: node.require("focal_length")?,
        screen_width: node.require("screen_width")?,
    };
    node.checked(camera, Camera::check)
}

pub(crate) fn render(node: &Node) -> Result<RenderSettings> {
    node.allow(&["background", "max_reflections", "antialiasing"])?;
    let default = RenderSettings::default();
    let settings = RenderSettings {
        background: node.optional("background", default.background)?,
        max_reflections: node.optional("max_reflections", default.max_reflections)?,
        antialiasing: node.optional("antialiasing", default.antialiasing)?,
        ..default
    };
    node.checked(settings, RenderSettings::check)
}

pub(crate) fn light(node: &Node) -> Result<Light> {
    node.allow(&["position", "color", "power"])?;
    let light = Light {
        position: node.require("position")?,
        color: node.optional("color", DVec3::ONE)?,
        power: node.optional("power", 1.0)?,
    };
    node.checked(light, Light::check)
}

pub(crate) fn material(node: &Node) -> Result<Material> {
    node.allow(&["color", "ambient", "diffuse", "specular", "shininess", "reflection"])?;
    let default = Material::new(node.require("color")?);
    let material = Material {
        color: default.color,
        ambient: node.optional("ambient", default.ambient)?,
        diffuse: node.optional("diffuse", default.diffuse)?,
        specular: node.optional("specular", default.specular)?,
        shininess: node.optional("shininess", default.shininess)?,
        reflection: node.optional("reflection", default.reflection)?,
    };
    node.checked(material, Material::check)
}

pub(crate) fn plane(node: &Node, materials: &mut MaterialRefs) -> Result<Plane> {
    node.allow(&["point", "normal", "material"])?;
    let plane = Plane {
        point: node.require("point")?,
        normal: node.require("normal")?,
        material: materials.number_in(node)?,
    };
    node.checked(plane, Plane::check)
}

pub(crate) fn sphere(node: &Node, materials: &mut MaterialRefs) -> Result<Sphere> {
    node.allow(&["center", "radius", "material"])?;
    let sphere = Sphere {
        center: node.require("center")?,
        radius: node.require("radius")?,
        material: materials.number_in(node)?,
    };
    node.checked(sphere, Sphere::check)
}

pub(crate) fn triangle(node: &Node, materials: &mut MaterialRefs) -> Result<Triangle> {
    node.allow(&["vertices", "material"])?;
    let triangle =
        Triangle { vertices: node.require("vertices")?, material: materials.number_in(node)? };
    node.checked(triangle, Triangle::check)
}

pub(crate) fn cylinder(node: &Node, materials: &mut MaterialRefs) -> Result<Cylinder> {
    node.allow(&["bottom", "top", "radius", "material"])?;
    let cylinder = Cylinder {
        bottom: node.require("bottom")?,
        top: node.require("top")?,
        radius: node.require("radius")?,
        material: materials.number_in(node)?,
    };
    node.checked(cylinder, Cylinder::check)
}

/// Reads a `[[mesh]]`, but not yet its file.
pub(crate) fn mesh(node: &Node, materials: &mut MaterialRefs) -> Result<Mesh> {
    node.allow(&["path", "material"])?;
    let path = node.inner("path")?;
    let mesh = Mesh {
        path: path.string()?.into(),
        material: materials.number_in(node)?,
        mention: path.mention(),
    };
    node.checked(mesh, Mesh::check)
}
