//! An analysis of a scene: which parts of the tracer it uses, found before it is rendered.

use crate::execution::{Acceleration, Execution};
use crate::formulas::{Compiled, Family, select};
use crate::scene::{Scene, SceneError};
use crate::simd::lane::Scalar;
use crate::trace::World;
use std::fmt;

/// The parts of the tracer that an image of a scene uses. The other parts cost it nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Analysis {
    /// The numbers of planes, spheres, triangles and cylinders. Rays skip a kind of which there is
    /// none.
    pub primitives: [usize; 4],
    /// The number of primitives that no ray reaches, and which are left out.
    pub behind: usize,
    /// The largest number of bounces of a ray: 0 if nothing reflects.
    pub bounces: u32,
    /// The number of lights, and of those that can light anything visible. Lights without power and
    /// lights behind a plane cannot.
    pub lights: (usize, usize),
    /// The number of planes that may hide each light that can.
    pub hiding_planes: Vec<usize>,
    /// The way in which a ray finds what it hits among the primitives that are not planes.
    pub search: HitSearch,
}

/// The way in which a ray finds what it hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitSearch {
    /// The ray tries each primitive.
    BruteForce,
    /// The ray tries the primitives whose direction cone holds it, if it starts at the eye or ends
    /// at a light. Other rays try each primitive, but triangles only if they come near one.
    Cones,
    /// The ray traverses a BVH.
    Bvh {
        /// The number of its leaves, of a few primitives each.
        leaves: usize,
    },
}

impl Analysis {
    /// Analyses `scene` as it is rendered with `execution`.
    ///
    /// # Errors
    ///
    /// A scene that [`Scene::check`] rejects.
    pub fn of(scene: &Scene, execution: &Execution) -> Result<Self, SceneError> {
        scene.check()?;
        let arguments = AnalysisArguments { scene, acceleration: execution.acceleration };
        Ok(select(scene.render.arithmetic, arguments))
    }
}

/// The arguments of an analysis, for which it is compiled in several arithmetics.
struct AnalysisArguments<'a> {
    scene: &'a Scene,
    acceleration: Acceleration,
}

impl Compiled for AnalysisArguments<'_> {
    type Output = Analysis;

    fn compiled<S: Scalar, F: Family>(self) -> Analysis {
        let scene = self.scene;
        let world = World::<S, F>::new(scene, Some(scene.camera.position), self.acceleration);
        let hiding_planes: Vec<usize> =
            world.lights.iter().map(|light| light.occluders.planes.len()).collect();
        let primitives =
            [scene.planes.len(), scene.spheres.len(), scene.triangles.len(), scene.cylinders.len()];
        Analysis {
            primitives,
            behind: primitives.iter().sum::<usize>() - world.primitives.count(),
            bounces: world.max_reflections,
            lights: (scene.lights.len(), hiding_planes.len()),
            hiding_planes,
            search: match (world.primitives.leaves(), &world.eye) {
                (Some(leaves), _) => HitSearch::Bvh { leaves },
                (None, Some(_)) => HitSearch::Cones,
                (None, None) => HitSearch::BruteForce,
            },
        }
    }
}

impl fmt::Display for Analysis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [planes, spheres, triangles, cylinders] = self.primitives;
        writeln!(
            f,
            "primitives: {planes} planes, {spheres} spheres, {triangles} triangles, \
             {cylinders} cylinders"
        )?;
        if self.behind > 0 {
            writeln!(f, "left out: {} of them, behind all that rays reach", self.behind)?;
        }
        match self.search {
            HitSearch::BruteForce => {
                writeln!(f, "acceleration: none, every ray tries every primitive")?;
            }
            HitSearch::Cones => writeln!(
                f,
                "acceleration: direction cones for rays from the eye, mirrored by planes or to a \
                 light; bounding spheres of triangles for the others"
            )?,
            HitSearch::Bvh { leaves } => {
                writeln!(f, "acceleration: a BVH with {leaves} leaves")?;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Light, Material, Plane, RenderSettings, Sphere};
    use crate::settings::Precision;
    use glam::DVec3;

    /// A floor, spheres on it, a light above, one below and one without power.
    fn scene(spheres: usize, reflection: f64) -> Scene {
        let light =
            |y, power| Light { position: DVec3::new(0.0, y, 0.0), color: DVec3::ONE, power };
        let sphere =
            |i| Sphere { center: DVec3::new(f64::from(i), 1.0, 0.0), radius: 0.4, material: 0 };
        Scene {
            camera: Camera {
                position: DVec3::new(0.0, 1.0, 9.0),
                look_at: DVec3::Y,
                up: DVec3::Y,
                focal_length: 1.0,
                screen_width: 1.0,
            },
            render: RenderSettings {
                arithmetic: Precision::F32.into(),
                ..RenderSettings::default()
            },
            materials: vec![Material { reflection, ..Material::new(DVec3::ONE) }],
            lights: vec![light(5.0, 1.0), light(-5.0, 1.0), light(5.0, 0.0)],
            planes: vec![Plane { point: DVec3::ZERO, normal: DVec3::Y, material: 0 }],
            spheres: (0..spheres as u32).map(sphere).collect(),
            triangles: Vec::new(),
            cylinders: Vec::new(),
        }
    }

    fn analysis(spheres: usize, reflection: f64, acceleration: Acceleration) -> Analysis {
        let execution = Execution { acceleration, ..Execution::default() };
        Analysis::of(&scene(spheres, reflection), &execution).expect("a sound scene")
    }

    /// Catches a light, a plane, a mirror or a BVH that is used though nothing needs it, or that is
    /// missing.
    #[test]
    fn what_is_not_needed_is_left_out() {
        let few = analysis(3, 0.0, Acceleration::Auto);
        assert_eq!((few.primitives, few.bounces, few.lights), ([1, 3, 0, 0], 0, (3, 1)));
        assert_eq!((few.hiding_planes.as_slice(), few.search), (&[0][..], HitSearch::Cones));
        assert_eq!(analysis(3, 0.5, Acceleration::Auto).bounces, 4);
        let many = analysis(100, 0.0, Acceleration::Auto).search;
        assert!(matches!(many, HitSearch::Bvh { leaves } if leaves > 10), "{many:?}");
        assert_eq!(analysis(100, 0.0, Acceleration::None).search, HitSearch::BruteForce);
    }

    /// Catches a primitive that is left out though a mirror or the way to a light behind the eye
    /// shows it; and one that is kept though nothing does.
    #[test]
    fn what_is_behind_is_left_out() {
        let behind = |reflection, light_z, acceleration| {
            let mut scene = scene(3, reflection);
            scene.lights[0].position.z = light_z;
            scene.spheres[1].center.z = 10.0;
            let execution = Execution { acceleration, ..Execution::default() };
            Analysis::of(&scene, &execution).expect("a sound scene").behind
        };
        assert_eq!(behind(0.0, 9.0, Acceleration::Auto), 1);
        // The sphere reaches from 9.6 to 10.4.
        assert_eq!(behind(0.0, 9.59, Acceleration::Auto), 1);
        assert_eq!(behind(0.0, 9.61, Acceleration::Auto), 0);
        assert_eq!(behind(0.1, 9.0, Acceleration::Auto), 0);
        assert_eq!(behind(0.0, 9.0, Acceleration::None), 0);
    }
}
