//! What the keys of a scene file mean: which there are, and what they default to.

use glam::DVec3;
use rayweave_core::Scene;
use rayweave_core::scene::{
    Camera, Cylinder, Fault, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};

use crate::draft::Mentions;
use crate::error::Problem;
use crate::fields::Fields;
use crate::mesh::Mesh;

/// All that a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The size of the picture.
    pub image: ImageSize,
    /// What is in the picture. It obeys [`Scene::check`].
    pub scene: Scene,
    /// How many triangles of the scene's meshes were left out because they have no area.
    pub skipped_triangles: usize,
}

/// The size of a picture in pixels.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct ImageSize {
    /// Pixels in a row, 1..=65535.
    pub width: u32,
    /// Rows, 1..=65535.
    pub height: u32,
}

/// The largest width and height of [`ImageSize`].
pub const MAX_SIDE: u32 = 65535;

impl Default for ImageSize {
    fn default() -> Self {
        Self { width: 500, height: 500 }
    }
}

impl ImageSize {
    /// Whether both sides are within the model's limits.
    ///
    /// # Errors
    ///
    /// The side that is not.
    pub fn check(&self) -> Result<(), Fault> {
        for (key, side) in [("width", self.width), ("height", self.height)] {
            if !(1..=MAX_SIDE).contains(&side) {
                return Err(Fault {
                    key,
                    expected: "an integer in 1..=65535",
                    found: side.to_string(),
                });
            }
        }
        Ok(())
    }
}

/// Reads a `[image]`.
pub(crate) fn image(fields: &Fields) -> Result<ImageSize, Problem> {
    fields.allow(&["width", "height"])?;
    let default = ImageSize::default();
    let size = ImageSize {
        width: fields.optional("width", default.width)?,
        height: fields.optional("height", default.height)?,
    };
    fields.checked(size, ImageSize::check)
}

/// Reads a `[camera]`.
pub(crate) fn camera(fields: &Fields) -> Result<Camera, Problem> {
    fields.allow(&["position", "look_at", "up", "focal_length", "screen_width"])?;
    let camera = Camera {
        position: fields.require("position")?,
        look_at: fields.require("look_at")?,
        up: fields.require("up")?,
        focal_length: fields.require("focal_length")?,
        screen_width: fields.require("screen_width")?,
    };
    fields.checked(camera, Camera::check)
}

/// Reads a `[render]`.
pub(crate) fn render(fields: &Fields) -> Result<RenderSettings, Problem> {
    fields.allow(&["background", "max_reflections", "antialiasing"])?;
    let default = RenderSettings::default();
    let settings = RenderSettings {
        background: fields.optional("background", default.background)?,
        max_reflections: fields.optional("max_reflections", default.max_reflections)?,
        antialiasing: fields.optional("antialiasing", default.antialiasing)?,
        sampling: default.sampling,
        adaptive: default.adaptive,
    };
    fields.checked(settings, RenderSettings::check)
}

/// Reads a `[[light]]`.
pub(crate) fn light(fields: &Fields) -> Result<Light, Problem> {
    fields.allow(&["position", "color", "power"])?;
    let light = Light {
        position: fields.require("position")?,
        color: fields.optional("color", DVec3::ONE)?,
        power: fields.optional("power", 1.0)?,
    };
    fields.checked(light, Light::check)
}

/// Reads a `[material.name]`.
pub(crate) fn material(fields: &Fields) -> Result<Material, Problem> {
    fields.allow(&["color", "ambient", "diffuse", "specular", "shininess", "reflection"])?;
    let default = Material::new(fields.require("color")?);
    let material = Material {
        color: default.color,
        ambient: fields.optional("ambient", default.ambient)?,
        diffuse: fields.optional("diffuse", default.diffuse)?,
        specular: fields.optional("specular", default.specular)?,
        shininess: fields.optional("shininess", default.shininess)?,
        reflection: fields.optional("reflection", default.reflection)?,
    };
    fields.checked(material, Material::check)
}

/// Reads a `[[plane]]`.
pub(crate) fn plane(fields: &Fields, materials: &mut Mentions) -> Result<Plane, Problem> {
    fields.allow(&["point", "normal", "material"])?;
    let plane = Plane {
        point: fields.require("point")?,
        normal: fields.require("normal")?,
        material: materials.index(&fields.field("material")?)?,
    };
    fields.checked(plane, Plane::check)
}

/// Reads a `[[sphere]]`.
pub(crate) fn sphere(fields: &Fields, materials: &mut Mentions) -> Result<Sphere, Problem> {
    fields.allow(&["center", "radius", "material"])?;
    let sphere = Sphere {
        center: fields.require("center")?,
        radius: fields.require("radius")?,
        material: materials.index(&fields.field("material")?)?,
    };
    fields.checked(sphere, Sphere::check)
}

/// Reads a `[[triangle]]`.
pub(crate) fn triangle(fields: &Fields, materials: &mut Mentions) -> Result<Triangle, Problem> {
    fields.allow(&["vertices", "material"])?;
    let triangle = Triangle {
        vertices: fields.require("vertices")?,
        material: materials.index(&fields.field("material")?)?,
    };
    fields.checked(triangle, Triangle::check)
}

/// Reads a `[[cylinder]]`.
pub(crate) fn cylinder(fields: &Fields, materials: &mut Mentions) -> Result<Cylinder, Problem> {
    fields.allow(&["bottom", "top", "radius", "material"])?;
    let cylinder = Cylinder {
        bottom: fields.require("bottom")?,
        top: fields.require("top")?,
        radius: fields.require("radius")?,
        material: materials.index(&fields.field("material")?)?,
    };
    fields.checked(cylinder, Cylinder::check)
}

/// Reads a `[[mesh]]`, but not yet its file.
pub(crate) fn mesh(fields: &Fields, materials: &mut Mentions) -> Result<Mesh, Problem> {
    fields.allow(&["path", "material"])?;
    Mesh::new(&fields.field("path")?, materials.index(&fields.field("material")?)?)
}
