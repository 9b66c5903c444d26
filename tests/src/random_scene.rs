//! Scenes of ordinary scale that use everything in the model, drawn by seed.

use crate::draw::Draw;
use crate::scenes;
use crate::transform::{enlarged, moved};
use glam::DVec3;
use rayweave_core::scene::{
    Camera, Cylinder, Light, MAX_SHININESS, Material, Plane, RenderSettings, Scene, Sphere,
    Triangle,
};

/// Draws the scene of this number: always the same, and accepted by [`Scene::check`].
///
/// Primitives stand within about 5 units of the origin, seen from up to 10 away, before the whole
/// is enlarged by 1/8 to 8 and moved. Some primitives are the exact copy of another in another
/// material: the first one is seen.
#[must_use]
pub fn random_scene(seed: u64) -> Scene {
    let mut draw = Draw::new(seed);
    let materials = draw.several(1..=6, Draw::material);
    let count = materials.len();
    let mut scene = Scene {
        render: draw.settings(),
        materials,
        planes: draw.several(0..=2, |draw| draw.plane(count)),
        spheres: draw.several(0..=6, |draw| draw.sphere(count)),
        triangles: draw.several(0..=6, |draw| draw.triangle(count)),
        cylinders: draw.several(0..=4, |draw| draw.cylinder(count)),
        ..scenes::empty()
    };
    if draw.chance(0.3) {
        scene.triangles.extend(draw.fan(count));
    }
    draw.copy_one(&mut scene.planes, |plane, material| plane.material = material, count);
    draw.copy_one(&mut scene.spheres, |sphere, material| sphere.material = material, count);
    draw.copy_one(&mut scene.triangles, |triangle, material| triangle.material = material, count);
    draw.copy_one(&mut scene.cylinders, |cylinder, material| cylinder.material = material, count);
    draw.place_camera(&mut scene);
    let camera = scene.camera;
    for plane in &mut scene.planes {
        // Most planes do not stand between the camera and the middle.
        let hides =
            plane.point.dot(plane.normal) * (plane.point - camera.position).dot(plane.normal) < 0.0;
        if hides && draw.chance(0.9) {
            plane.point = -plane.point;
        }
    }
    let fewest = u32::from(draw.chance(0.9));
    scene.lights = draw.several(fewest..=4, |draw| draw.light(&camera));
    for light in &mut scene.lights {
        // Most planes do not stand between the camera and the light either.
        for Plane { point, normal, .. } in &scene.planes {
            let normal = normal.normalize();
            let height = (light.position - point).dot(normal);
            if height * (camera.position - point).dot(normal) < 0.0 && draw.chance(0.8) {
                light.position -= 2.0 * height * normal;
            }
        }
    }
    let (scale, shift) = (draw.magnitude(0.125, 8.0), draw.within(4.0));
    moved(&enlarged(&scene, scale), shift)
}

impl Draw {
    fn settings(&mut self) -> RenderSettings {
        RenderSettings {
            background: if self.chance(0.3) { DVec3::ZERO } else { self.color() },
            max_reflections: if self.chance(0.9) {
                self.integer(0..=8)
            } else {
                self.integer(9..=64)
            },
            antialiasing: self.integer(0..=4),
            ..RenderSettings::default()
        }
    }

    fn material(&mut self) -> Material {
        Material {
            color: self.color(),
            ambient: if self.chance(0.2) { 0.0 } else { self.between(0.05, 0.4) },
            diffuse: if self.chance(0.1) { 0.0 } else { self.between(0.3, 1.1) },
            specular: if self.chance(0.2) { 0.0 } else { self.between(0.0, 1.1) },
            shininess: match self.integer(0..=9) {
                0 => 1,
                1 => MAX_SHININESS,
                _ => self.magnitude(1.0, f64::from(MAX_SHININESS)).round() as u32,
            },
            reflection: match self.integer(0..=9) {
                0..=4 => 0.0,
                5 => 1.0,
                _ => self.unit(),
            },
        }
    }

    /// A plane. Few go through the middle of the scene, where a plane hides half of it.
    fn plane(&mut self, materials: usize) -> Plane {
        let out = self.direction();
        let most = if self.chance(0.5) { 0.0 } else { 0.3 };
        let tilt = self.within(most);
        let side = if self.chance(0.5) { 1.0 } else { -1.0 };
        let (point, normal) = match self.integer(0..=9) {
            0..=5 => (DVec3::new(0.0, -self.between(1.0, 5.0), 0.0), DVec3::Y + tilt),
            6..=8 => (out * self.between(3.0, 12.0), out + tilt),
            _ => (self.within(3.0), out),
        };
        Plane {
            point,
            normal: normal * side * self.magnitude(0.05, 20.0),
            material: self.index(materials),
        }
    }

    fn sphere(&mut self, materials: usize) -> Sphere {
        let radius = self.magnitude(0.2, 2.5);
        Sphere { center: self.within(3.5), radius, material: self.index(materials) }
    }

    fn triangle(&mut self, materials: usize) -> Triangle {
        let centre = self.within(2.5);
        loop {
            let size = self.between(0.8, 3.5);
            let vertices = [(); 3].map(|()| centre + self.within(size));
            if is_stout(vertices) {
                return Triangle { vertices, material: self.index(materials) };
            }
        }
    }

    /// Triangles that share edges: a hat, or a part of one.
    fn fan(&mut self, materials: usize) -> Vec<Triangle> {
        let (tip, axis, size) = (self.within(2.0), self.direction(), self.between(1.0, 3.0));
        let (right, front) = axis.any_orthonormal_pair();
        let (steep, material) = (self.between(-1.0, 1.0), self.index(materials));
        let corners = self.integer(4..=9);
        let turn = self.between(0.5, 1.0) * std::f64::consts::TAU / f64::from(corners);
        let corner = |k: u32| {
            let (sin, cos) = libm::sincos(turn * f64::from(k));
            tip + size * (cos * right + sin * front - steep * axis)
        };
        (0..corners)
            .map(|k| Triangle { vertices: [tip, corner(k), corner(k + 1)], material })
            .collect()
    }

    fn cylinder(&mut self, materials: usize) -> Cylinder {
        let bottom = self.within(3.0);
        let height = self.magnitude(0.2, 5.0);
        Cylinder {
            bottom,
            top: bottom + height * DVec3::Y,
            radius: self.magnitude(0.1, 2.0),
            material: self.index(materials),
        }
    }

    fn light(&mut self, camera: &Camera) -> Light {
        let view = (camera.look_at - camera.position).normalize();
        let position = match self.integer(0..=9) {
            0..=3 => self.within(15.0) + 10.0 * DVec3::Y,
            4..=5 => self.within(4.0),
            6..=7 => self.within(20.0),
            8 => camera.position - self.between(1.0, 10.0) * view,
            _ => camera.position,
        };
        let power = match self.integer(0..=9) {
            0 => 0.0,
            1..=2 => 1.0,
            _ => self.between(0.0, 1.5),
        };
        Light { position, color: if self.chance(0.4) { DVec3::ONE } else { self.color() }, power }
    }

    /// Sets the camera, and sometimes puts a primitive around it or in its view.
    fn place_camera(&mut self, scene: &mut Scene) {
        let count = scene.materials.len();
        let distance = self.magnitude(0.1, 10.0);
        let (position, look_at) = match self.integer(0..=11) {
            // Straight down.
            0 => {
                let position = self.within(3.0) + 8.0 * DVec3::Y;
                (position, position - distance * DVec3::Y)
            }
            // From inside a sphere.
            1 => {
                let position = self.within(5.0);
                let radius = self.between(2.0, 15.0);
                let center = position + self.direction() * radius * self.between(0.0, 0.8);
                scene.spheres.push(Sphere { center, radius, material: self.index(count) });
                (position, position + distance * self.direction())
            }
            // From inside a cylinder.
            2 => {
                let position = self.within(3.0);
                let radius = self.between(1.0, 5.0);
                let aside = self.direction() * DVec3::new(1.0, 0.0, 1.0);
                let bottom = position + aside * radius * self.between(0.0, 0.8)
                    - self.between(0.5, 4.0) * DVec3::Y;
                let top = DVec3 { y: position.y + self.between(0.5, 4.0), ..bottom };
                scene.cylinders.push(Cylinder { bottom, top, radius, material: self.index(count) });
                (position, position + distance * self.direction())
            }
            // From above into a cylinder.
            3 => {
                let mut cylinder = self.cylinder(count);
                cylinder.radius = self.between(0.5, 2.0);
                let position = cylinder.top + self.within(2.0) + self.between(3.0, 6.0) * DVec3::Y;
                scene.cylinders.push(cylinder);
                (position, cylinder.bottom)
            }
            // From anywhere to anywhere.
            4 => {
                let position = self.within(6.0);
                (position, position + distance * self.direction())
            }
            // From outside to the middle.
            _ => (self.direction() * self.between(5.0, 10.0), self.within(1.5)),
        };
        let focal_length = self.magnitude(0.1, 10.0);
        scene.camera = Camera {
            position,
            look_at,
            up: self.up(look_at - position),
            focal_length,
            screen_width: focal_length * self.magnitude(0.4, 2.5),
        };
    }

    /// An up vector, neither of length 1 nor at a right angle to the view, but well beside it.
    fn up(&mut self, view: DVec3) -> DVec3 {
        let mut up = DVec3::Y;
        while up.cross(view.normalize()).length() < 0.15 {
            up = self.direction();
        }
        if self.chance(0.5) {
            let other = self.direction();
            if other.cross(view.normalize()).length() > 0.15 {
                up = other;
            }
        }
        up * self.magnitude(0.03, 30.0)
    }
}

/// Returns true for a triangle that is no sliver, whose image does not depend on the rounding of
/// its corners.
fn is_stout([a, b, c]: [DVec3; 3]) -> bool {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    (b - a).cross(c - a).length() > 0.1 * longest * longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, Primitive, Ray};

    const SEEDS: u64 = 2000;

    fn scenes() -> impl Iterator<Item = Scene> {
        (0..SEEDS).map(random_scene)
    }

    #[test]
    fn every_scene_is_sound() {
        for seed in 0..SEEDS {
            assert_eq!(random_scene(seed).check(), Ok(()), "seed {seed}");
        }
    }

    #[test]
    fn a_seed_is_one_scene_and_two_seeds_are_two() {
        assert_eq!(random_scene(7), random_scene(7));
        assert_ne!(random_scene(7), random_scene(8));
    }

    /// Catches a feature that is never drawn: each of these is in at least one scene of a hundred.
    #[test]
    fn everything_is_drawn() {
        type Question = (&'static str, fn(&Scene) -> bool);
        fn of_material(scene: &Scene, is: fn(&Material) -> bool) -> bool {
            scene.materials.iter().any(is)
        }
        fn view(scene: &Scene) -> DVec3 {
            (scene.camera.look_at - scene.camera.position).normalize()
        }
        let questions: [Question; 31] = [
            ("no light", |s| s.lights.is_empty()),
            ("several lights", |s| s.lights.len() > 2),
            ("a light without power", |s| s.lights.iter().any(|l| l.power == 0.0)),
            ("a strong light", |s| s.lights.iter().any(|l| l.power > 1.2)),
            ("a coloured light", |s| s.lights.iter().any(|l| l.color != DVec3::ONE)),
            ("a light behind the camera", |s| {
                s.lights.iter().any(|l| (l.position - s.camera.position).dot(view(s)) < 0.0)
            }),
            ("a light in a sphere", |s| {
                s.lights
                    .iter()
                    .any(|l| s.spheres.iter().any(|o| l.position.distance(o.center) < o.radius))
            }),
            ("no plane", |s| s.planes.is_empty()),
            ("several planes", |s| s.planes.len() > 1),
            ("no sphere", |s| s.spheres.is_empty()),
            ("several spheres", |s| s.spheres.len() > 3),
            ("no triangle", |s| s.triangles.is_empty()),
            ("several triangles", |s| s.triangles.len() > 3),
            ("no cylinder", |s| s.cylinders.is_empty()),
            ("several cylinders", |s| s.cylinders.len() > 2),
            ("all four kinds", |s| {
                !s.planes.is_empty()
                    && !s.spheres.is_empty()
                    && !s.triangles.is_empty()
                    && !s.cylinders.is_empty()
            }),
            ("a skew normal", |s| {
                s.planes.iter().any(|p| p.normal.to_array().iter().all(|&x| x != 0.0))
            }),
            ("a short normal", |s| s.planes.iter().any(|p| p.normal.length() < 0.5)),
            ("two spheres in one place", |s| {
                let places: Vec<_> = s.spheres.iter().map(|o| o.center.to_array()).collect();
                places.iter().enumerate().any(|(i, place)| places[..i].contains(place))
            }),
            ("the camera in a sphere", |s| {
                s.spheres.iter().any(|o| s.camera.position.distance(o.center) < o.radius)
            }),
            ("the camera in a cylinder", |s| {
                let p = s.camera.position;
                s.cylinders.iter().any(|c| {
                    (c.bottom.y..c.top.y).contains(&p.y)
                        && DVec3 { y: c.bottom.y, ..p }.distance(c.bottom) < c.radius
                })
            }),
            ("the camera straight down", |s| view(s) == -DVec3::Y),
            ("an up that is not unit", |s| !(0.5..=2.0).contains(&s.camera.up.length())),
            ("a narrow view", |s| s.camera.screen_width < 0.5 * s.camera.focal_length),
            ("a wide view", |s| s.camera.screen_width > 2.0 * s.camera.focal_length),
            ("no mirror", |s| !of_material(s, |m| m.reflection > 0.0)),
            ("a half mirror", |s| of_material(s, |m| m.reflection > 0.0 && m.reflection < 1.0)),
            ("a full mirror", |s| of_material(s, |m| m.reflection == 1.0)),
            ("the least and most shininess", |s| {
                of_material(s, |m| m.shininess == 1)
                    && of_material(s, |m| m.shininess == MAX_SHININESS)
            }),
            ("no bounce", |s| s.render.max_reflections == 0),
            ("many bounces", |s| s.render.max_reflections > 8),
        ];
        for (what, is_so) in questions {
            let times = scenes().filter(is_so).count();
            assert!(times * 100 >= SEEDS as usize, "{what}: {times} of {SEEDS}");
        }
        for density in 0..=4 {
            assert!(scenes().any(|scene| scene.render.antialiasing == density));
        }
    }

    /// Catches scenes of which nothing is seen: most images show something, and each kind is seen,
    /// triangles from both sides.
    #[test]
    fn the_primitives_are_seen() {
        let mut seen = [0; 6];
        for scene in scenes() {
            let camera = &scene.camera;
            let ray = Ray {
                origin: camera.position,
                direction: (camera.look_at - camera.position).normalize(),
            };
            let model = Model::new(&scene);
            let what = match model.nearest(&ray, 0.0) {
                None => 0,
                Some((_, Primitive::Plane(_))) => 1,
                Some((_, Primitive::Sphere(_))) => 2,
                Some((_, front @ Primitive::Triangle(_))) => {
                    if front.normal(camera.position).dot(ray.direction) < 0.0 { 3 } else { 4 }
                }
                Some((_, Primitive::Cylinder(_))) => 5,
            };
            seen[what] += 1;
        }
        assert!(seen[0] < SEEDS / 2, "{seen:?}");
        assert!(seen.iter().all(|&times| times >= SEEDS / 50), "{seen:?}");
    }
}
