//! What a scene needs: found out once, before it is rendered.

use crate::formulas::{Compiled, Family};
use crate::lane::Scalar;
use crate::scene::{Scene, SceneError};
use crate::trace::World;
use crate::tracer::{Execution, Search};
use std::fmt;

/// What of the tracer a picture of a scene uses; what it does not use costs it nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Analysis {
    /// Planes, spheres, triangles and cylinders. Rays do not look for a kind that is not there.
    pub primitives: [usize; 4],
    /// The most bounces of a ray: 0 if nothing mirrors.
    pub bounces: u32,
    /// Lights, and how many of them can light anything that is seen: not those without power, nor those behind a
    /// plane.
    pub lights: (usize, usize),
    /// For each light that can, the planes that may hide it.
    pub hiding_planes: Vec<usize>,
    /// How a ray finds what it hits among the primitives that are not planes.
    pub search: Found,
}

/// How a ray finds what it hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// It tries each.
    Each,
    /// It tries those in whose direction it goes, if it starts at the eye or ends at a light; else each.
    Cones,
    /// It follows a tree of boxes of this many leaves.
    Tree {
        /// Of a few primitives each.
        leaves: usize,
    },
}

impl Analysis {
    /// Of `scene`, rendered by `execution`.
    ///
    /// # Errors
    ///
    /// A scene that [`Scene::check`] rejects.
    pub fn of(scene: &Scene, execution: &Execution) -> Result<Self, SceneError> {
        scene.check()?;
        Ok(execution.arithmetic.select(Looked { scene, search: execution.search }))
    }
}

/// What an analysis is compiled for.
struct Looked<'a> {
    scene: &'a Scene,
    search: Search,
}

impl Compiled for Looked<'_> {
    type Output = Analysis;

    fn compiled<S: Scalar, F: Family>(self) -> Analysis {
        let scene = self.scene;
        let world = World::<S, F>::new(scene, Some(scene.camera.position), self.search);
        let hiding_planes: Vec<usize> = world.lights.iter().map(|light| light.planes.len()).collect();
        Analysis {
            primitives: [
                scene.planes.len(),
                scene.spheres.len(),
                scene.triangles.len(),
                scene.cylinders.len(),
            ],
            bounces: world.max_reflections,
            lights: (scene.lights.len(), hiding_planes.len()),
            hiding_planes,
            search: match (world.primitives.leaves(), &world.eye) {
                (Some(leaves), _) => Found::Tree { leaves },
                (None, Some(_)) => Found::Cones,
                (None, None) => Found::Each,
            },
        }
    }
}

impl fmt::Display for Analysis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [planes, spheres, triangles, cylinders] = self.primitives;
        writeln!(
            f,
            "primitives: {planes} planes, {spheres} spheres, {triangles} triangles, {cylinders} cylinders"
        )?;
        match self.search {
            Found::Each => writeln!(f, "search: every ray tries every primitive")?,
            Found::Cones => writeln!(
                f,
                "search: rays from the eye and to a light try what is in their direction; others each primitive"
            )?,
            Found::Tree { leaves } => writeln!(f, "search: a tree of boxes with {leaves} leaves")?,
        }
        match self.bounces {
            0 => writeln!(f, "mirrors: none")?,
            bounces => writeln!(f, "mirrors: up to {bounces} bounces")?,
        }
        let (all, useful) = self.lights;
        let hidden = match self.hiding_planes.iter().max() {
            Some(0) => "no plane can hide them",
            Some(_) => "planes may hide them",
            None => "nothing looks for light",
        };
        write!(f, "lights: {useful} of {all} can light what is seen; {hidden}")
    }
}
