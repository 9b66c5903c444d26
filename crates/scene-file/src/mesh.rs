//! A `[[mesh]]`: which file it names, and what becomes of the triangles in it.

use std::path::{Component, Path, PathBuf};

use glam::DVec3;
use rayweave_core::scene::Triangle;

use crate::error::{Problem, Refusal, SceneFileError};
use crate::fields::Field;
use crate::{load, obj};

/// The most triangles that the meshes of a scene may have together: 8,388,608. A face of a few
/// bytes can stand for any number of them, so the size of the files alone is no limit.
pub const MAX_MESH_TRIANGLES: usize = 8 << 20;

/// A mesh whose file is yet to be read.
pub(crate) struct Mesh {
    path: PathBuf,
    material: usize,
    /// What to say if there is no triangle in the file.
    empty: Problem,
}

/// The triangles of a scene.
pub(crate) struct Triangles {
    /// Those with an area.
    pub(crate) kept: Vec<Triangle>,
    /// How many of the meshes' had none.
    pub(crate) skipped: usize,
    /// How many more meshes may have.
    left: usize,
}

impl Mesh {
    /// The mesh whose path is the value of `field`.
    ///
    /// The rule is about the words of the path: it leads down. A link in the folder is followed
    /// wherever it leads, because whoever put it there could have put the file there.
    pub(crate) fn new(field: &Field, material: usize) -> Result<Self, Problem> {
        let path = PathBuf::from(field.string()?);
        let down = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if path.as_os_str().is_empty() || !path.components().all(down) {
            return Err(field.expected("a path in the folder of the scene file, without `..`"));
        }
        let empty = format!(
            "expected an OBJ file with a triangle that has an area, found {}",
            field.written()
        );
        Ok(Self { path, material, empty: field.problem(empty) })
    }

    /// Appends the mesh to `triangles`; its file is looked for in `folder`.
    pub(crate) fn read(
        self,
        folder: Option<&Path>,
        triangles: &mut Triangles,
    ) -> Result<(), Refusal> {
        let Some(folder) = folder else {
            return Err(self
                .empty
                .adding("a scene that is not read from a file has no meshes")
                .into());
        };
        let file = folder.join(&self.path);
        let name = file.display().to_string();
        let bytes =
            load::bytes_of(&file).map_err(|message| SceneFileError::of_file(&name, message))?;
        let before = triangles.kept.len();
        obj::read(&bytes, |vertices| triangles.add(vertices, self.material))
            .map_err(|fault| fault.within(&bytes, &name))?;
        if triangles.kept.len() == before { Err(self.empty.into()) } else { Ok(()) }
    }
}

impl Triangles {
    /// The scene's own triangles, which come before those of meshes.
    pub(crate) fn after(own: Vec<Triangle>) -> Self {
        Self { kept: own, skipped: 0, left: MAX_MESH_TRIANGLES }
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
            Ok(()) => self.kept.push(triangle),
            Err(_) => self.skipped += 1,
        }
        Ok(())
    }
}
