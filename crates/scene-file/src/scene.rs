//! What the keys of a scene file mean: which there are, and what they default to.

use std::collections::BTreeMap;

use glam::DVec3;
use rayweave_core::Scene;
use rayweave_core::scene::{
    Camera, Cylinder, Fault, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};
use toml::de::DeTable;

use crate::error::Problem;
use crate::fields::{Field, Fields};
use crate::phrase;

/// All that a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The size of the picture.
    pub image: ImageSize,
    /// What is in the picture. It obeys [`Scene::check`].
    pub scene: Scene,
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
                return Err(Fault { key, expected: "an integer in 1..=65535", found: side.to_string() });
            }
        }
        Ok(())
    }
}

/// Index into [`Scene::materials`] by name.
type Names<'a> = BTreeMap<&'a str, usize>;

/// Reads a whole document, of which `text` is the source.
pub(crate) fn read(text: &str, document: &DeTable<'_>) -> Result<SceneFile, Problem> {
    let document = Fields::of_document(text, document);
    if let Some(mesh) = document.get("mesh") {
        return Err(mesh.problem("meshes are not supported by this version".into()));
    }
    document.allow(&[
        "image", "camera", "render", "light", "material", "plane", "sphere", "triangle", "cylinder",
    ])?;
    let image = document.get("image").map_or(Ok(ImageSize::default()), |field| image(&field.table()?))?;
    let camera = camera(&document.field("camera")?.table()?)?;
    let render =
        document.get("render").map_or(Ok(RenderSettings::default()), |field| render(&field.table()?))?;
    let lights = document.each("light", light)?;

    let table = document.get("material");
    let table = table.as_ref().map(Field::table).transpose()?;
    let mut names = Names::new();
    let mut materials = Vec::new();
    for (name, field) in table.iter().flat_map(Fields::iter) {
        names.insert(name, materials.len());
        materials.push(material(&field.table()?)?);
    }

    let scene = Scene {
        camera,
        render,
        lights,
        materials,
        planes: document.each("plane", |fields| plane(fields, &names))?,
        spheres: document.each("sphere", |fields| sphere(fields, &names))?,
        triangles: document.each("triangle", |fields| triangle(fields, &names))?,
        cylinders: document.each("cylinder", |fields| cylinder(fields, &names))?,
    };
    Ok(SceneFile { image, scene })
}

fn image(fields: &Fields) -> Result<ImageSize, Problem> {
    fields.allow(&["width", "height"])?;
    let default = ImageSize::default();
    let size = ImageSize {
        width: fields.optional("width", default.width)?,
        height: fields.optional("height", default.height)?,
    };
    fields.checked(size, ImageSize::check)
}

fn camera(fields: &Fields) -> Result<Camera, Problem> {
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

fn render(fields: &Fields) -> Result<RenderSettings, Problem> {
    fields.allow(&["background", "max_reflections", "antialiasing"])?;
    let default = RenderSettings::default();
    let settings = RenderSettings {
        background: fields.optional("background", default.background)?,
        max_reflections: fields.optional("max_reflections", default.max_reflections)?,
        antialiasing: fields.optional("antialiasing", default.antialiasing)?,
        sampling: default.sampling,
    };
    fields.checked(settings, RenderSettings::check)
}

fn light(fields: &Fields) -> Result<Light, Problem> {
    fields.allow(&["position", "color", "power"])?;
    let light = Light {
        position: fields.require("position")?,
        color: fields.optional("color", DVec3::ONE)?,
        power: fields.optional("power", 1.0)?,
    };
    fields.checked(light, Light::check)
}

fn material(fields: &Fields) -> Result<Material, Problem> {
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

fn plane(fields: &Fields, names: &Names) -> Result<Plane, Problem> {
    fields.allow(&["point", "normal", "material"])?;
    let plane = Plane {
        point: fields.require("point")?,
        normal: fields.require("normal")?,
        material: reference(&fields.field("material")?, names)?,
    };
    fields.checked(plane, Plane::check)
}

fn sphere(fields: &Fields, names: &Names) -> Result<Sphere, Problem> {
    fields.allow(&["center", "radius", "material"])?;
    let sphere = Sphere {
        center: fields.require("center")?,
        radius: fields.require("radius")?,
        material: reference(&fields.field("material")?, names)?,
    };
    fields.checked(sphere, Sphere::check)
}

fn triangle(fields: &Fields, names: &Names) -> Result<Triangle, Problem> {
    fields.allow(&["vertices", "material"])?;
    let triangle = Triangle {
        vertices: fields.require("vertices")?,
        material: reference(&fields.field("material")?, names)?,
    };
    fields.checked(triangle, Triangle::check)
}

fn cylinder(fields: &Fields, names: &Names) -> Result<Cylinder, Problem> {
    fields.allow(&["bottom", "top", "radius", "material"])?;
    let cylinder = Cylinder {
        bottom: fields.require("bottom")?,
        top: fields.require("top")?,
        radius: fields.require("radius")?,
        material: reference(&fields.field("material")?, names)?,
    };
    fields.checked(cylinder, Cylinder::check)
}

/// The index of the material that `field` names.
fn reference(field: &Field, names: &Names) -> Result<usize, Problem> {
    let name = field.string()?;
    names.get(name).copied().ok_or_else(|| {
        let instead = phrase::instead(name, names.keys().copied());
        field.problem(format!("expected the name of a material, found {}; {instead}", field.source()))
    })
}
