//! A scene in the making: what the parts of a file that were read so far say together.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use rayweave_core::Scene;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};

use crate::error::{Problem, Refusal};
use crate::fields::{Field, Fields};
use crate::mesh::{Mesh, Triangles};
use crate::phrase;
use crate::scene::{self, ImageSize, SceneFile};

/// The keys at the top of a scene file.
const KEYS: [&str; 10] = [
    "image", "camera", "render", "light", "material", "plane", "sphere", "triangle", "mesh",
    "cylinder",
];

/// Those of [`KEYS`] that stand for any number of entries, each under a header `[[key]]`.
pub(crate) const ENTRIES: [&str; 6] = ["light", "plane", "sphere", "triangle", "mesh", "cylinder"];

/// All that was read. The `material` of a primitive is a number in [`Mentions`] until the end.
#[derive(Default)]
pub(crate) struct Draft {
    image: Option<ImageSize>,
    camera: Option<Camera>,
    render: Option<RenderSettings>,
    lights: Vec<Light>,
    materials: BTreeMap<String, Material>,
    mentions: Mentions,
    planes: Vec<Plane>,
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    meshes: Vec<Mesh>,
    cylinders: Vec<Cylinder>,
    /// The keys that stood in a part before and may not come again.
    closed: BTreeSet<String>,
}

impl Draft {
    /// Adds the next part of the file.
    pub(crate) fn add(&mut self, part: &Fields) -> Result<(), Problem> {
        part.allow(&KEYS)?;
        if let Some((key, _)) = part.iter().find(|&(key, _)| self.closed.contains(key)) {
            return Err(part.duplicate(key));
        }
        if let Some(field) = part.get("image") {
            self.image = Some(scene::image(&field.table()?)?);
        }
        if let Some(field) = part.get("camera") {
            self.camera = Some(scene::camera(&field.table()?)?);
        }
        if let Some(field) = part.get("render") {
            self.render = Some(scene::render(&field.table()?)?);
        }
        part.each("light", &mut self.lights, scene::light)?;
        if let Some(field) = part.get("material") {
            self.add_materials(&field.table()?)?;
        }
        let mentions = &mut self.mentions;
        part.each("plane", &mut self.planes, |fields| scene::plane(fields, mentions))?;
        part.each("sphere", &mut self.spheres, |fields| scene::sphere(fields, mentions))?;
        part.each("triangle", &mut self.triangles, |fields| scene::triangle(fields, mentions))?;
        part.each("mesh", &mut self.meshes, |fields| scene::mesh(fields, mentions))?;
        part.each("cylinder", &mut self.cylinders, |fields| scene::cylinder(fields, mentions))?;
        let grows = |key: &str, field: &Field| {
            (key == "material" || ENTRIES.contains(&key)) && field.is_under_headers()
        };
        let closed =
            part.iter().filter(|(key, field)| !grows(key, field)).map(|(key, _)| key.to_owned());
        self.closed.extend(closed);
        Ok(())
    }

    fn add_materials(&mut self, table: &Fields) -> Result<(), Problem> {
        for (name, field) in table.iter() {
            if self.materials.contains_key(name) {
                return Err(table.duplicate(name));
            }
            self.materials.insert(name.to_owned(), scene::material(&field.table()?)?);
        }
        Ok(())
    }

    /// The scene, now that the whole file is read, with the meshes that lie in `folder`.
    pub(crate) fn finish(self, folder: Option<&Path>) -> Result<SceneFile, Refusal> {
        let camera = self
            .camera
            .ok_or_else(|| Problem::of_key(0, "camera".into(), "missing, but required".into()))?;
        let index = self.mentions.resolve(&self.materials)?;
        let mut triangles = Triangles::after(self.triangles);
        for mesh in self.meshes {
            mesh.read(folder, &mut triangles)?;
        }
        let mut scene = Scene {
            camera,
            render: self.render.unwrap_or_default(),
            lights: self.lights,
            materials: self.materials.into_values().collect(),
            planes: self.planes,
            spheres: self.spheres,
            triangles: triangles.kept,
            cylinders: self.cylinders,
        };
        scene.planes.iter_mut().for_each(|plane| plane.material = index[plane.material]);
        scene.spheres.iter_mut().for_each(|sphere| sphere.material = index[sphere.material]);
        scene
            .triangles
            .iter_mut()
            .for_each(|triangle| triangle.material = index[triangle.material]);
        scene
            .cylinders
            .iter_mut()
            .for_each(|cylinder| cylinder.material = index[cylinder.material]);
        let image = self.image.unwrap_or_default();
        Ok(SceneFile { image, scene, skipped_triangles: triangles.skipped })
    }
}

/// The materials that primitives refer to, numbered as they were first mentioned: the material
/// itself may come further down in the file.
#[derive(Default)]
pub(crate) struct Mentions {
    numbers: BTreeMap<String, usize>,
    /// What to say, of each, where there is no such material.
    unknown: Vec<Problem>,
}

impl Mentions {
    /// The number of the material that `field` names.
    pub(crate) fn index(&mut self, field: &Field) -> Result<usize, Problem> {
        let name = field.string()?;
        if let Some(&number) = self.numbers.get(name) {
            return Ok(number);
        }
        let number = self.unknown.len();
        let message = format!("expected the name of a material, found {}", field.written());
        self.unknown.push(field.problem(message));
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }

    /// Of each number the place of its material among all that there are.
    fn resolve(self, materials: &BTreeMap<String, Material>) -> Result<Vec<usize>, Problem> {
        let places: BTreeMap<&str, usize> = materials.keys().map(String::as_str).zip(0..).collect();
        let mut names: Vec<(&str, usize)> =
            self.numbers.iter().map(|(name, &number)| (name.as_str(), number)).collect();
        names.sort_unstable_by_key(|&(_, number)| number);
        let mut resolved = Vec::with_capacity(names.len());
        for ((name, _), problem) in names.into_iter().zip(self.unknown) {
            let Some(&place) = places.get(name) else {
                return Err(problem.adding(&phrase::instead(name, places.keys().copied())));
            };
            resolved.push(place);
        }
        Ok(resolved)
    }
}
