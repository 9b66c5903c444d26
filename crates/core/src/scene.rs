//! The scene: camera, lights, materials and primitives as plain data, and the rules that they obey.
//!
//! Every number is an `f64` in scene units and every colour is linear RGB in 0..=1; the tracer
//! rounds them once to the precision it works in. The fields are public, and [`Scene::check`] tells
//! whether they are valid. The rules are written here and nowhere else: a reader of scene files
//! adds to a [`SceneFault`] the position in the file.

pub use crate::fault::{SceneError, SceneFault};
pub use crate::settings::{MAX_ANTIALIASING, MAX_REFLECTIONS, RenderSettings, Sampling};

use crate::fault::{check_all, color, expect, finite, locate, not_negative, positive};
use crate::settings::Arithmetic;
use glam::DVec3;

/// A whole scene: everything that decides the image, except its size in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The camera.
    pub camera: Camera,
    /// The settings that change the image.
    pub render: RenderSettings,
    /// Point lights, in file order.
    pub lights: Vec<Light>,
    /// The materials that primitives refer to by index.
    pub materials: Vec<Material>,
    /// Infinite planes; the first kind in the order that decides between equal distances.
    pub planes: Vec<Plane>,
    /// Spheres; the second kind.
    pub spheres: Vec<Sphere>,
    /// Triangles; the third kind.
    pub triangles: Vec<Triangle>,
    /// Open vertical cylinders; the last kind.
    pub cylinders: Vec<Cylinder>,
}

/// A pinhole camera: an eye, and a screen at `focal_length` in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The position of the eye.
    pub position: DVec3,
    /// A point that appears in the middle of the image; not the eye itself.
    pub look_at: DVec3,
    /// A direction that appears upwards, of any length above 0; not parallel to the view.
    pub up: DVec3,
    /// The distance from the eye to the screen, above 0.
    pub focal_length: f64,
    /// The full width of the screen, above 0. Its height follows from the image's proportions.
    pub screen_width: f64,
}

/// A point light without fall-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The position of the light.
    pub position: DVec3,
    /// The colour of the light.
    pub color: DVec3,
    /// The factor on the colour, 0 or more.
    pub power: f64,
}

/// The response of a surface to light (Phong, 1975), and the share of it that is a mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The surface's own colour.
    pub color: DVec3,
    /// The share of the colour that is there without any light, 0 or more.
    pub ambient: f64,
    /// The share of the colour under a light straight above, 0 or more.
    pub diffuse: f64,
    /// The strength of the highlight, 0 or more.
    pub specular: f64,
    /// The exponent of the highlight, 1..=1024.
    pub shininess: u32,
    /// The share of the mirrored colour, 0..=1.
    pub reflection: f64,
}

impl Material {
    /// Returns a material of this colour with the model's defaults for everything else.
    #[must_use]
    pub fn new(color: DVec3) -> Self {
        Self { color, ambient: 0.1, diffuse: 0.6, specular: 0.4, shininess: 2, reflection: 0.0 }
    }
}

/// An infinite plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of the plane.
    pub point: DVec3,
    /// The normal, of any length above 0.
    pub normal: DVec3,
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub center: DVec3,
    /// The radius, above 0.
    pub radius: f64,
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// A triangle, edges included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The corners, not on one line.
    pub vertices: [DVec3; 3],
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// The wall of a cylinder whose axis is parallel to y, without caps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The lower end of the axis.
    pub bottom: DVec3,
    /// The upper end of the axis: `bottom` with a greater y.
    pub top: DVec3,
    /// The radius, above 0.
    pub radius: f64,
    /// Index into [`Scene::materials`].
    pub material: usize,
}

/// The largest value of [`Material::shininess`].
pub const MAX_SHININESS: u32 = 1024;

impl Scene {
    /// Returns a copy that is rendered in this arithmetic.
    #[must_use]
    pub fn with_arithmetic(&self, arithmetic: impl Into<Arithmetic>) -> Self {
        let mut scene = self.clone();
        scene.render.arithmetic = arithmetic.into();
        scene
    }

    /// Checks that every entry obeys the model, each on its own and in its reference to a material.
    ///
    /// # Errors
    ///
    /// The first entry that does not, in the order camera, render, lights, materials, planes,
    /// spheres, triangles, cylinders.
    pub fn check(&self) -> Result<(), SceneError> {
        let count = self.materials.len();
        let known = |material: usize| {
            expect("material", material < count, "the index of a material", material)
        };
        locate("camera", self.camera.check())?;
        locate("render", self.render.check())?;
        check_all("light", &self.lights, Light::check)?;
        check_all("material", &self.materials, Material::check)?;
        check_all("plane", &self.planes, |p| p.check().and(known(p.material)))?;
        check_all("sphere", &self.spheres, |s| s.check().and(known(s.material)))?;
        check_all("triangle", &self.triangles, |t| t.check().and(known(t.material)))?;
        check_all("cylinder", &self.cylinders, |c| c.check().and(known(c.material)))
    }
}

impl Camera {
    /// Checks that the camera has finite numbers, a direction, an `up` that is not parallel to it,
    /// and a screen.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        finite("position", self.position)?;
        finite("look_at", self.look_at)?;
        finite("up", self.up)?;
        positive("focal_length", self.focal_length)?;
        positive("screen_width", self.screen_width)?;
        let differs = self.look_at != self.position;
        expect("look_at", differs, "a point other than `position`", self.look_at)?;
        expect("up", self.up != DVec3::ZERO, "a vector other than zero", self.up)?;
        let beside = !parallel(self.look_at - self.position, self.up);
        expect("up", beside, "a direction not parallel to the view", self.up)
    }
}

impl Light {
    /// Checks that the light is finite, has a colour in 0..=1 and a power of 0 or more.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        finite("position", self.position)?;
        color("color", self.color)?;
        not_negative("power", self.power)
    }
}

impl Material {
    /// Checks that every share and the exponent are in their ranges.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        color("color", self.color)?;
        not_negative("ambient", self.ambient)?;
        not_negative("diffuse", self.diffuse)?;
        not_negative("specular", self.specular)?;
        let exponent = self.shininess;
        expect(
            "shininess",
            (1..=MAX_SHININESS).contains(&exponent),
            "an integer in 1..=1024",
            exponent,
        )?;
        let share = self.reflection;
        expect("reflection", (0.0..=1.0).contains(&share), "a number in 0..=1", share)
    }
}

impl Plane {
    /// Checks that the plane is finite and has a normal.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        finite("point", self.point)?;
        finite("normal", self.normal)?;
        expect("normal", self.normal != DVec3::ZERO, "a vector other than zero", self.normal)
    }
}

impl Sphere {
    /// Checks that the sphere is finite and has a radius.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        finite("center", self.center)?;
        positive("radius", self.radius)
    }
}

impl Triangle {
    /// Returns the centre and radius of a sphere around the triangle, seldom the smallest.
    pub(crate) fn around(&self) -> (DVec3, f64) {
        let [a, b, c] = self.vertices;
        let middle = (a.min(b).min(c) + a.max(b).max(c)) / 2.0;
        (middle, self.vertices.map(|v| v.distance(middle)).into_iter().fold(0.0, f64::max))
    }

    /// Checks that the triangle is finite and has an area.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        let [a, b, c] = self.vertices;
        for vertex in [a, b, c] {
            finite("vertices", vertex)?;
        }
        let found = format_args!("{a}, {b}, {c}");
        expect("vertices", !parallel(b - a, c - a), "three corners that span an area", found)
    }
}

impl Cylinder {
    /// Checks that the cylinder is finite and upright, and has a height and a radius.
    ///
    /// # Errors
    ///
    /// The first key that breaks a rule.
    pub fn check(&self) -> Result<(), SceneFault> {
        finite("bottom", self.bottom)?;
        finite("top", self.top)?;
        positive("radius", self.radius)?;
        let upright = self.top.x == self.bottom.x && self.top.z == self.bottom.z;
        expect("top", upright, "a point with the x and z of `bottom`", self.top)?;
        expect("top", self.top.y > self.bottom.y, "a point above `bottom`", self.top)
    }
}

/// Returns `v` scaled by a power of two, which rounds nothing, so that its largest component is
/// near 1.
pub(crate) fn near_one(v: DVec3) -> DVec3 {
    let (_, exponent) = libm::frexp(v.abs().max_element());
    v.to_array().map(|component| libm::scalbn(component, -exponent)).into()
}

/// Returns the normal of the plane through a triangle's corners, of a length near 1.
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    near_one(near_one(b - a).cross(near_one(c - a)))
}

/// Returns `v` at unit length, for any finite `v` except zero. It is scaled first, so that no
/// square overflows.
pub(crate) fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize()
}

/// Returns whether two vectors span no area, up to the rounding of their own components.
pub(crate) fn parallel(a: DVec3, b: DVec3) -> bool {
    // Scaled to about 1 first, so that no product overflows or vanishes.
    let (a, b) = (a / a.abs().max_element(), b / b.abs().max_element());
    let area = a.cross(b).length();
    // NaN, from a zero vector, counts as parallel.
    area.is_nan() || area <= 8.0 * f64::EPSILON * a.length() * b.length()
}
