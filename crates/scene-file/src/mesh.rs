//! A `[[mesh]]`: the file that it names, and the triangles in that file.

use std::path::{Component, Path, PathBuf};

use glam::DVec3;
use rayweave_core::scene::{SceneFault, Triangle};

use crate::error::{Result, Source};
use crate::node::Mention;
use crate::{obj, read_file, wording};

/// The most triangles that the meshes of a scene may have together: 8,388,608. A face of a few
/// bytes can stand for any number of them, so the size of the files alone is no limit.
pub const MAX_MESH_TRIANGLES: usize = 8 << 20;

/// A mesh whose file is yet to be read.
pub(crate) struct Mesh {
    pub(crate) path: PathBuf,
    pub(crate) material: usize,
    /// The path in the scene file, at fault if there is no triangle in the file.
    pub(crate) mention: Mention,
}

/// The triangles of a scene and of its meshes.
pub(crate) struct MeshTriangles {
    /// The triangles that have an area.
    pub(crate) all: Vec<Triangle>,
    /// The number of the meshes' triangles that have none.
    pub(crate) skipped: usize,
    /// The number of triangles that meshes may still have.
    left: usize,
}

impl Mesh {
    /// Checks that the path stays in the scene file's folder.
    ///
    /// The rule is about the words of the path. A link in the folder is followed wherever it leads,
    /// because whoever put it there could have put the file there.
    pub(crate) fn check(&self) -> Result<(), SceneFault> {
        let down = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if !self.path.as_os_str().is_empty() && self.path.components().all(down) {
            return Ok(());
        }
        let expected = "a path in the folder of the scene file, without `..`";
        Err(SceneFault { key: "path", expected, found: self.path.display().to_string() })
    }

    /// Appends the mesh to `triangles`. Its file, which is returned, is in the `folder` of `scene`.
    pub(crate) fn read(
        self,
        scene: Source,
        folder: Option<&Path>,
        triangles: &mut MeshTriangles,
    ) -> Result<PathBuf> {
        let expected = "expected an OBJ file with a triangle that has an area";
        let empty = format!("{expected}, found {}", self.mention.written);
        let Some(folder) = folder else {
            let hint = "a scene that is not read from a file has no meshes";
            return Err(self.mention.error(scene, &format!("{empty}; {hint}")));
        };
        let file = folder.join(&self.path);
        let name = wording::path(&file);
        let bytes = read_file::bytes_of(&file, &name)?;
        let before = triangles.all.len();
        obj::read(&bytes, &name, |vertices| triangles.add(vertices, self.material))?;
        if triangles.all.len() == before {
            Err(self.mention.error(scene, &empty))
        } else {
            Ok(file)
        }
    }
}

impl MeshTriangles {
    /// Begins with the scene's own triangles, which come before those of meshes.
    pub(crate) fn after(own: Vec<Triangle>) -> Self {
        Self { all: own, skipped: 0, left: MAX_MESH_TRIANGLES }
    }

    fn add(&mut self, vertices: [DVec3; 3], material: usize) -> Result<(), String> {
        let Some(left) = self.left.checked_sub(1) else {
            return Err(format!(
                "more than the {MAX_MESH_TRIANGLES} triangles that the meshes of a scene may have"
            ));
        };
        self.left = left;
        let triangle = Triangle { vertices, material };
        // The vertices are finite: all that can be wrong is the area.
        match triangle.check() {
            Ok(()) => self.all.push(triangle),
            Err(_) => self.skipped += 1,
        }
        Ok(())
    }
}
