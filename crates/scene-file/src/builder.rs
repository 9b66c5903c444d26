//! A scene that is put together from the parts of its file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use rayweave_core::Scene;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};

use crate::error::{Result, Source};
use crate::keys;
use crate::material_refs::MaterialRefs;
use crate::mesh::{Mesh, MeshTriangles};
use crate::node::{Definition, Node};
use crate::scene_file::{ImageSize, SceneFile};

/// The keys at the top of a scene file.
const KEYS: [&str; 10] = [
    "image", "camera", "render", "light", "material", "plane", "sphere", "triangle", "mesh",
    "cylinder",
];

/// The keys at the top that stand for any number of entries, each under a header `[[key]]`.
pub(crate) const ENTRIES: [&str; 6] = ["light", "plane", "sphere", "triangle", "mesh", "cylinder"];

/// Everything that was read so far. The `material` of a primitive is a number of [`MaterialRefs`]
/// until the end.
#[derive(Default)]
pub(crate) struct SceneBuilder {
    image: Option<ImageSize>,
    camera: Option<Camera>,
    render: Option<RenderSettings>,
    lights: Vec<Light>,
    materials: BTreeMap<String, Material>,
    refs: MaterialRefs,
    planes: Vec<Plane>,
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    meshes: Vec<Mesh>,
    cylinders: Vec<Cylinder>,
    /// True if `[material]` itself, not only a material in it, is defined. It may not be again.
    material_is_defined: bool,
    /// The keys of earlier parts that may not come again: complete, or written inline.
    closed: BTreeSet<String>,
}

impl SceneBuilder {
    /// Adds the next part of the file.
    pub(crate) fn add(&mut self, part: &Node) -> Result<()> {
        part.allow(&KEYS)?;
        let table = part.table()?;
        let material = part.get("material");
        let again = self.material_is_defined
            && material.is_some_and(|node| node.definition() == Definition::Header);
        let is_closed = |name: &str| self.closed.contains(name) || (again && name == "material");
        if let Some(key) = table.keys().find(|key| is_closed(key.get_ref())) {
            return Err(part.duplicate(key));
        }
        self.material_is_defined |=
            material.is_some_and(|node| node.definition() != Definition::Inner);
        if let Some(node) = part.get("image") {
            self.image = Some(keys::image(&node)?);
        }
        if let Some(node) = part.get("camera") {
            self.camera = Some(keys::camera(&node)?);
        }
        if let Some(node) = part.get("render") {
            self.render = Some(keys::render(&node)?);
        }
        part.each("light", &mut self.lights, keys::light)?;
        if let Some(node) = material {
            self.add_materials(&node)?;
        }
        let refs = &mut self.refs;
        part.each("plane", &mut self.planes, |node| keys::plane(node, refs))?;
        part.each("sphere", &mut self.spheres, |node| keys::sphere(node, refs))?;
        part.each("triangle", &mut self.triangles, |node| keys::triangle(node, refs))?;
        part.each("mesh", &mut self.meshes, |node| keys::mesh(node, refs))?;
        part.each("cylinder", &mut self.cylinders, |node| keys::cylinder(node, refs))?;
        let names = table.keys().map(|key| key.get_ref().as_ref());
        let grows = |name: &str| {
            (name == "material" || ENTRIES.contains(&name))
                && part.get(name).is_some_and(|node| node.is_under_headers())
        };
        self.closed.extend(names.filter(|name| !grows(name)).map(str::to_owned));
        Ok(())
    }

    fn add_materials(&mut self, node: &Node) -> Result<()> {
        for key in node.table()?.keys() {
            let name = key.get_ref().as_ref();
            if self.materials.contains_key(name) {
                return Err(node.duplicate(key));
            }
            self.materials.insert(name.to_owned(), keys::material(&node.inner(name)?)?);
        }
        Ok(())
    }

    /// Returns the scene of the whole `file`, with the meshes that lie in `folder`.
    pub(crate) fn finish(self, file: Source, folder: Option<&Path>) -> Result<SceneFile> {
        let missing = || file.error(0, Some("camera".into()), "missing, but required");
        let camera = self.camera.ok_or_else(missing)?;
        let index = self.refs.resolve(&self.materials, file)?;
        let mut triangles = MeshTriangles::after(self.triangles);
        let read = |mesh: Mesh| mesh.read(file, folder, &mut triangles);
        let meshes = self.meshes.into_iter().map(read).collect::<Result<_>>()?;
        let mut scene = Scene {
            camera,
            render: self.render.unwrap_or_default(),
            lights: self.lights,
            materials: self.materials.into_values().collect(),
            planes: self.planes,
            spheres: self.spheres,
            triangles: triangles.all,
            cylinders: self.cylinders,
        };
        let numbers = (scene.planes.iter_mut().map(|plane| &mut plane.material))
            .chain(scene.spheres.iter_mut().map(|sphere| &mut sphere.material))
            .chain(scene.triangles.iter_mut().map(|triangle| &mut triangle.material))
            .chain(scene.cylinders.iter_mut().map(|cylinder| &mut cylinder.material));
        numbers.for_each(|material| *material = index[*material]);
        let image = self.image.unwrap_or_default();
        Ok(SceneFile { image, scene, skipped_triangles: triangles.skipped, meshes })
    }
}
