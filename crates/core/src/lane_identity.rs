//! Proof that there is room for packets: a lane of four numbers gives each the bits of one alone.

use crate::camera::Camera;
use crate::execution::Search;
use crate::formulas::Robust;
use crate::lane::{Lane, Mask};
use crate::scene::{self, RenderSettings, Scene};
use crate::trace::World;
use glam::DVec3;
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Four numbers side by side, as slow as can be.
#[derive(Clone, Copy, Debug)]
struct Quad([f32; 4]);

#[derive(Clone, Copy, Debug)]
struct QuadMask([bool; 4]);

impl Quad {
    fn map(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(from_fn(|i| f(self.0[i], other.0[i])))
    }

    fn compare(self, other: Self, f: impl Fn(f32, f32) -> bool) -> QuadMask {
        QuadMask(from_fn(|i| f(self.0[i], other.0[i])))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Quad {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.map(other, $trait::$method)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Quad {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl BitAnd for QuadMask {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }
}

impl BitOr for QuadMask {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }
}

impl Not for QuadMask {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.map(|lane| !lane))
    }
}

impl Mask for QuadMask {
    fn any(self) -> bool {
        self.0.contains(&true)
    }
    fn bits(self) -> u32 {
        (0..4).map(|i| u32::from(self.0[i]) << i).sum()
    }
}

impl Lane for Quad {
    type Scalar = f32;
    type Mask = QuadMask;
    type Index = [u32; 4];
    const LANES: usize = 4;

    fn from_fn(number: impl FnMut(usize) -> f32) -> Self {
        Self(from_fn(number))
    }
    fn load(numbers: &[f32]) -> Self {
        Self(from_fn(|i| numbers[i]))
    }
    fn store(self, numbers: &mut [f32]) {
        numbers[..4].copy_from_slice(&self.0);
    }
    fn first_lanes(count: usize) -> QuadMask {
        QuadMask(from_fn(|i| i < count))
    }
    fn splat(x: f32) -> Self {
        Self([x; 4])
    }
    fn splat_index(index: u32) -> [u32; 4] {
        [index; 4]
    }
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    fn min(self, other: Self) -> Self {
        self.map(other, Lane::min)
    }
    fn max(self, other: Self) -> Self {
        self.map(other, Lane::max)
    }
    fn lt(self, other: Self) -> QuadMask {
        self.compare(other, |a, b| a < b)
    }
    fn le(self, other: Self) -> QuadMask {
        self.compare(other, |a, b| a <= b)
    }
    fn equals(self, other: Self) -> QuadMask {
        self.compare(other, |a, b| a == b)
    }
    fn select(mask: QuadMask, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
    fn select_index(mask: QuadMask, yes: [u32; 4], no: [u32; 4]) -> [u32; 4] {
        from_fn(|i| if mask.0[i] { yes[i] } else { no[i] })
    }
    fn first(mask: QuadMask, numbers: [Self; 3]) -> Option<[f32; 3]> {
        mask.0.iter().position(|&lane| lane).map(|i| numbers.map(|number| number.0[i]))
    }
    fn first_index(mask: QuadMask, indices: [u32; 4]) -> Option<u32> {
        mask.0.iter().position(|&lane| lane).map(|i| indices[i])
    }
    fn mix(index: [u32; 4], with: [u32; 4]) -> [u32; 4] {
        from_fn(|i| f32::mix(index[i], with[i]))
    }
    fn store_index(index: [u32; 4], numbers: &mut [u32]) {
        numbers[..4].copy_from_slice(&index);
    }
    fn index_equals(indices: [u32; 4], index: u32) -> QuadMask {
        QuadMask(indices.map(|i| i == index))
    }
    fn index_above(indices: [u32; 4], index: u32) -> QuadMask {
        QuadMask(indices.map(|i| i > index))
    }
}

/// Every kind of primitive, mirrors, several exponents, two lights, a view along the diagonal: so
/// neighbouring rays differ in what they hit, how often they bounce and which axis is longest.
fn scene() -> Scene {
    let v = DVec3::new;
    let material = |color, shininess, reflection| scene::Material {
        shininess,
        reflection,
        ..scene::Material::new(color)
    };
    Scene {
        camera: scene::Camera {
            position: v(4.0, 4.1, 3.9),
            look_at: v(0.0, 0.0, 0.0),
            up: v(0.0, 1.0, 0.0),
            focal_length: 1.0,
            screen_width: 2.0,
        },
        render: RenderSettings {
            background: v(0.1, 0.2, 0.3),
            max_reflections: 6,
            antialiasing: 2,
            ..RenderSettings::default()
        },
        lights: vec![
            scene::Light { position: v(5.0, 8.0, 1.0), color: v(1.0, 0.9, 0.8), power: 0.8 },
            scene::Light { position: v(-3.0, 2.0, 6.0), color: v(0.5, 0.6, 1.0), power: 0.7 },
        ],
        materials: vec![
            material(v(0.8, 0.8, 0.8), 2, 0.5),
            material(v(1.0, 0.2, 0.1), 31, 0.0),
            material(v(0.1, 0.2, 1.0), 7, 0.9),
        ],
        planes: vec![scene::Plane {
            point: v(0.0, -1.0, 0.0),
            normal: v(0.1, 1.0, 0.0),
            material: 0,
        }],
        spheres: vec![
            scene::Sphere { center: v(0.0, 0.0, 0.0), radius: 1.0, material: 2 },
            scene::Sphere { center: v(1.5, -0.5, 0.5), radius: 0.5, material: 1 },
        ],
        triangles: vec![
            scene::Triangle {
                vertices: [v(-2.0, -1.0, 0.0), v(0.0, 2.0, -2.0), v(2.0, -1.0, -3.0)],
                material: 0,
            },
            scene::Triangle {
                vertices: [v(-2.0, -1.0, 0.0), v(-1.0, 1.0, 2.0), v(0.0, 2.0, -2.0)],
                material: 1,
            },
        ],
        cylinders: vec![scene::Cylinder {
            bottom: v(-0.5, -1.0, 1.8),
            top: v(-0.5, 0.5, 1.8),
            radius: 0.4,
            material: 2,
        }],
    }
}

#[test]
fn four_lanes_give_the_bits_of_one() {
    let scene = scene();
    let world = World::<f32, Robust>::new(&scene, None, Search::Exhaustive);
    let camera = Camera::<f32>::new(&scene.camera, 40, 1);
    let bits = |right: f32, down: f32| {
        let color = world.trace(camera.ray(right, down), true, false).color;
        [color.x, color.y, color.z].map(f32::to_bits)
    };
    // Neighbours first, then lanes that have nothing to do with each other.
    for stride in [1, 13] {
        for down in (-39..40_i16).step_by(2) {
            for right in -39..40_i16 {
                let places: [f32; 4] =
                    from_fn(|i| f32::from((right + 39 + i as i16 * stride) % 79 - 39));
                let down = f32::from(down);
                let rays = camera.ray(Quad(places), Quad::splat(down));
                let color = world.trace(rays, QuadMask([true, true, false, true]), false).color;
                for lane in [0, 1, 3] {
                    let found =
                        [color.x, color.y, color.z].map(|channel| channel.0[lane].to_bits());
                    assert_eq!(
                        found,
                        bits(places[lane], down),
                        "lane {lane} at ({}, {down})",
                        places[lane]
                    );
                }
            }
        }
    }
}
