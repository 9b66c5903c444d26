//! Scenes to time rays in: their primitives are of one kind, and the number of rays of an image is
//! known.

use rayweave_contract::{Image, Tile, Work};
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};
use rayweave_core::{Arithmetic, Execution, Precision, Scene, tracer};
use rayweave_measure::random::SplitMix64;
use std::f64::consts::PI;
use std::num::NonZeroU32;

/// The side of a tile, as the command line's default.
const TILE: NonZeroU32 = NonZeroU32::new(32).expect("not 0");

/// An image to be timed.
pub struct Probe {
    scene: Scene,
    width: u32,
    height: u32,
    /// One tile in this many is rendered: rays are as close to each other as in the whole image, in
    /// a part of its time.
    one_tile_in: usize,
}

/// The rays that follow a ray from the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rays {
    /// None: there is no light and no mirror.
    FromEye,
    /// One ray to a light, which is at the eye: every visible surface faces it.
    AndShadows,
    /// One ray from a mirror.
    AndMirrored,
}

/// A kind of primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Infinite planes.
    Planes,
    /// Spheres.
    Spheres,
    /// Triangles.
    Triangles,
    /// Open cylinders.
    Cylinders,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Planes, Self::Spheres, Self::Triangles, Self::Cylinders];

    /// The name in those of the benches.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Planes => "planes",
            Self::Spheres => "spheres",
            Self::Triangles => "triangles",
            Self::Cylinders => "cylinders",
        }
    }
}

impl Probe {
    /// An empty scene, for the cost of a ray that meets nothing.
    #[must_use]
    pub fn empty() -> Self {
        Self::small(Rays::FromEye)
    }

    /// Eight primitives of one kind beside each other, which fill 40 to 85 % of the image: planes
    /// all of it, as the walls of a tunnel.
    #[must_use]
    pub fn of(kind: Kind, rays: Rays) -> Self {
        let mut probe = Self::small(rays);
        let scene = &mut probe.scene;
        for number in 0..8 {
            let (column, row) = (f64::from(number % 4), f64::from(number / 4));
            let (x, y) = (2.0 * column - 3.0, 2.0 * row - 1.0);
            match kind {
                Kind::Planes => {
                    let (sine, cosine) = (PI * (f64::from(number) + 0.5) / 4.0).sin_cos();
                    let (point, normal) = ([3.0 * cosine, 3.0 * sine, 0.0], [cosine, sine, 0.0]);
                    scene.planes.push(Plane {
                        point: point.into(),
                        normal: normal.into(),
                        material: 0,
                    });
                }
                Kind::Spheres => {
                    scene.spheres.push(Sphere {
                        center: [x, y, 0.0].into(),
                        radius: 0.9,
                        material: 0,
                    });
                }
                Kind::Triangles => {
                    let corners =
                        [[x - 0.9, y - 0.9, 0.3], [x + 0.9, y - 0.9, -0.3], [x, y + 0.9, 0.0]];
                    scene
                        .triangles
                        .push(Triangle { vertices: corners.map(Into::into), material: 0 });
                }
                Kind::Cylinders => {
                    let (bottom, top) = ([x, y - 0.9, 0.0].into(), [x, y + 0.9, 0.0].into());
                    scene.cylinders.push(Cylinder { bottom, top, radius: 0.9, material: 0 });
                }
            }
        }
        probe
    }

    /// Spheres anywhere in a cube, all of it in the image. They are the smaller the more there are:
    /// the number that a ray meets stays the same.
    #[must_use]
    pub fn cloud(count: u32, rays: Rays) -> Self {
        let mut scene = scene(26.0, 1.2, rays);
        let mut random = SplitMix64::new(u64::from(count));
        let mean_radius = 0.1 * (1e5 / f64::from(count)).sqrt();
        scene.spheres.extend((0..count).map(|_| Sphere {
            center: [(); 3].map(|()| between(&mut random, -10.0, 10.0)).into(),
            radius: mean_radius * between(&mut random, 0.5, 1.5),
            material: 0,
        }));
        Self { scene, width: 800, height: 608, one_tile_in: 59 }
    }

    /// The whole image of a scene.
    #[must_use]
    pub fn whole(scene: Scene, width: u32, height: u32) -> Self {
        Self { scene, width, height, one_tile_in: 1 }
    }

    /// An empty scene, of which the image shows 8 by 4 at the origin.
    fn small(rays: Rays) -> Self {
        Self::whole(scene(8.0, 1.0, rays), 64, 32)
    }

    /// The work of rendering it in this arithmetic.
    ///
    /// # Panics
    ///
    /// The scene is not sound.
    #[must_use]
    pub fn work(&self, arithmetic: Arithmetic, execution: Execution) -> Box<dyn Work + Send> {
        let scene = self.scene.with_arithmetic(arithmetic);
        tracer(&scene, self.width, self.height, execution).unwrap_or_else(|e| panic!("{e}"))
    }

    /// An image for it, all NaN.
    ///
    /// # Panics
    ///
    /// No memory.
    #[must_use]
    pub fn image(&self) -> Image {
        Image::filled(self.width, self.height, [f32::NAN; 3]).expect("a small image")
    }

    /// The tiles that are rendered.
    #[must_use]
    pub fn tiles<'a>(&self, image: &'a mut Image) -> Vec<Tile<'a>> {
        image.tiles(TILE).into_iter().step_by(self.one_tile_in).collect()
    }

    /// The number of pixels in these tiles.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        let mut image = self.image();
        let areas = self.tiles(&mut image).iter().map(Tile::rect).collect::<Vec<_>>();
        areas.iter().map(|rect| u64::from(rect.width) * u64::from(rect.height)).sum()
    }

    /// The number of pixels in these tiles whose first ray hits something. It is rendered once to
    /// count them.
    #[must_use]
    pub fn hits(&self) -> u64 {
        let work = self.work(Precision::F32.into(), Execution::default());
        let mut image = self.image();
        self.tiles(&mut image).iter_mut().for_each(|tile| work.render(tile));
        // A pixel that is not rendered is NaN, one without a hit is black.
        image.pixels().iter().filter(|[red, ..]| *red > 0.0).count() as u64
    }
}

/// An empty scene, seen from `(0, 0, distance)` towards the origin.
fn scene(distance: f64, screen_width: f64, rays: Rays) -> Scene {
    let position = [0.0, 0.0, distance].into();
    let mirror = if rays == Rays::AndMirrored { 0.5 } else { 0.0 };
    let light = Light { position, color: [1.0; 3].into(), power: 1.0 };
    Scene {
        camera: Camera {
            position,
            look_at: [0.0; 3].into(),
            up: [0.0, 1.0, 0.0].into(),
            focal_length: 1.0,
            screen_width,
        },
        render: RenderSettings {
            max_reflections: if rays == Rays::AndMirrored { 1 } else { 0 },
            antialiasing: 0,
            ..RenderSettings::default()
        },
        lights: if rays == Rays::AndShadows { vec![light] } else { Vec::new() },
        materials: vec![Material { reflection: mirror, ..Material::new([0.8; 3].into()) }],
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    }
}

fn between(random: &mut SplitMix64, low: f64, high: f64) -> f64 {
    low + (high - low) * random.fraction()
}
