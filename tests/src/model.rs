//! A second implementation of `docs/MODEL.md`, in its order and as plainly as `f64` allows.
//!
//! It shares the scene's types with the tracer and nothing else: no lattice, no packets, no
//! culling. Where the model says "at the point", a distance of a billionth of the coordinates
//! involved counts as none; nothing else here is a tolerance.

use glam::DVec3;
use rayweave_core::scene::{Camera, Cylinder, Light, Material, Plane, Scene, Sphere, Triangle};

/// Renders `scene` in linear light, not clamped: row by row from the top.
#[must_use]
pub fn render(scene: &Scene, width: u32, height: u32) -> Vec<[f64; 3]> {
    let model = Model::new(scene);
    let pixels = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
    pixels.map(|(i, j)| model.pixel(i, j, width, height).to_array()).collect()
}

/// A half-line. `t` counts in units of `direction`, of whatever length that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point where it starts.
    pub origin: DVec3,
    /// Its direction, not zero.
    pub direction: DVec3,
}

impl Ray {
    /// The point at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

// Camera

/// The ray through image coordinates `(x, y)`, where pixel `(i, j)` has its centre at
/// `(i + 0.5, j + 0.5)`.
#[must_use]
pub fn primary_ray(camera: &Camera, x: f64, y: f64, width: u32, height: u32) -> Ray {
    let (width, height) = (f64::from(width), f64::from(height));
    let f = (camera.look_at - camera.position).normalize();
    let r = f.cross(camera.up).normalize();
    let u = r.cross(f);
    let screen_height = camera.screen_width * height / width;
    let screen_point = camera.focal_length * f
        + (x / width - 0.5) * camera.screen_width * r
        + (0.5 - y / height) * screen_height * u;
    Ray { origin: camera.position, direction: screen_point.normalize() }
}

// Nearest hit

/// One primitive of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "each is the type of that name")]
pub enum Primitive {
    Plane(Plane),
    Sphere(Sphere),
    Triangle(Triangle),
    Cylinder(Cylinder),
}

impl Primitive {
    /// Every `t` of any sign at which the ray's line meets the surface; a tangent's twice.
    #[must_use]
    pub fn roots(&self, ray: &Ray) -> [Option<f64>; 2] {
        match self {
            Self::Plane(plane) => [plane_root(plane.point, plane.normal, ray), None],
            Self::Sphere(Sphere { center, radius, .. }) => {
                roots_at_distance(*radius, center - ray.origin, ray.direction)
            }
            Self::Triangle(triangle) => [triangle_root(triangle, ray), None],
            Self::Cylinder(cylinder) => cylinder_roots(cylinder, ray),
        }
    }

    /// The smallest `t > 0`, if any.
    #[must_use]
    pub fn hit(&self, ray: &Ray) -> Option<f64> {
        self.roots(ray).into_iter().flatten().filter(|&t| t > 0.0).min_by(f64::total_cmp)
    }

    /// The geometric normal at a point of the surface, of length 1: a plane's own, a triangle's
    /// `(b - a) x (c - a)`, outwards for the others.
    #[must_use]
    pub fn normal(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Plane(plane) => plane.normal,
            Self::Sphere(sphere) => point - sphere.center,
            Self::Triangle(triangle) => triangle_normal(triangle),
            Self::Cylinder(cylinder) => horizontal(point - cylinder.bottom),
        }
        .normalize()
    }

    /// Returns the same primitive in this material.
    #[must_use]
    pub fn of(self, material: usize) -> Self {
        match self {
            Self::Plane(plane) => Self::Plane(Plane { material, ..plane }),
            Self::Sphere(sphere) => Self::Sphere(Sphere { material, ..sphere }),
            Self::Triangle(triangle) => Self::Triangle(Triangle { material, ..triangle }),
            Self::Cylinder(cylinder) => Self::Cylinder(Cylinder { material, ..cylinder }),
        }
    }

    fn material(&self) -> usize {
        match self {
            Self::Plane(plane) => plane.material,
            Self::Sphere(sphere) => sphere.material,
            Self::Triangle(triangle) => triangle.material,
            Self::Cylinder(cylinder) => cylinder.material,
        }
    }
}

/// The root of a plane, unless the ray is parallel to it.
fn plane_root(point: DVec3, normal: DVec3, ray: &Ray) -> Option<f64> {
    let slope = ray.direction.dot(normal);
    (slope != 0.0).then(|| (point - ray.origin).dot(normal) / slope)
}

/// The root of a triangle: the ray passes its three sides, or their ends, all on the same hand.
fn triangle_root(triangle: &Triangle, ray: &Ray) -> Option<f64> {
    let [a, b, c] = triangle.vertices.map(|vertex| vertex - ray.origin);
    let hands = [(a, b), (b, c), (c, a)].map(|(from, to)| ray.direction.dot(from.cross(to)));
    let inside = hands.iter().all(|&hand| hand >= 0.0) || hands.iter().all(|&hand| hand <= 0.0);
    plane_root(triangle.vertices[0], triangle_normal(triangle), ray).filter(|_| inside)
}

/// The roots of a cylinder's wall, each tested for its height.
fn cylinder_roots(cylinder: &Cylinder, ray: &Ray) -> [Option<f64>; 2] {
    let to_axis = horizontal(cylinder.bottom - ray.origin);
    roots_at_distance(cylinder.radius, to_axis, horizontal(ray.direction))
        .map(|root| root.filter(|&t| (cylinder.bottom.y..=cylinder.top.y).contains(&ray.at(t).y)))
}

/// The `t` with `|t direction - to_centre| = radius`: equally far before and beyond the closest
/// approach. The one nearer to 0 follows from their product, which is 0 on the surface itself.
fn roots_at_distance(radius: f64, to_centre: DVec3, direction: DVec3) -> [Option<f64>; 2] {
    let squared = direction.length_squared();
    if squared == 0.0 {
        return [None; 2];
    }
    let closest = to_centre.dot(direction) / squared;
    let distance = (to_centre - closest * direction).length();
    if distance > radius {
        return [None; 2];
    }
    let half_chord = ((radius - distance) * (radius + distance) / squared).sqrt();
    let far = closest + half_chord.copysign(closest);
    let product = (to_centre.length_squared() - radius * radius) / squared;
    let near = if far == 0.0 { 0.0 } else { product / far };
    [Some(near.min(far)), Some(near.max(far))]
}

fn triangle_normal(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.vertices;
    (b - a).cross(c - a)
}

fn horizontal(v: DVec3) -> DVec3 {
    DVec3::new(v.x, 0.0, v.z)
}

/// The distance that counts as none between points computed from `a` and `b`.
fn negligible(a: DVec3, b: DVec3) -> f64 {
    1e-9 * a.abs().max(b.abs()).max_element()
}

/// A scene with its primitives in the order that decides between equal distances.
#[derive(Clone, Debug)]
pub struct Model<'a> {
    scene: &'a Scene,
    /// Planes, spheres, triangles and cylinders, each in the scene's order.
    pub primitives: Vec<Primitive>,
}

/// A point of a surface as a ray sees it.
struct Seen<'a> {
    point: DVec3,
    /// Unit, and turned against the ray.
    n: DVec3,
    /// The ray's unit direction.
    d: DVec3,
    material: &'a Material,
    /// Up to here a further ray is still at the point.
    at_point: f64,
}

impl<'a> Model<'a> {
    /// A scene that [`Scene::check`] accepts.
    #[must_use]
    pub fn new(scene: &'a Scene) -> Self {
        let mut primitives: Vec<_> = scene.planes.iter().copied().map(Primitive::Plane).collect();
        primitives.extend(scene.spheres.iter().copied().map(Primitive::Sphere));
        primitives.extend(scene.triangles.iter().copied().map(Primitive::Triangle));
        primitives.extend(scene.cylinders.iter().copied().map(Primitive::Cylinder));
        Self { scene, primitives }
    }

    /// Every root strictly between `after` and `before`, with its primitive.
    fn hits(&self, ray: &Ray, after: f64, before: f64) -> impl Iterator<Item = (f64, &Primitive)> {
        self.primitives
            .iter()
            .flat_map(move |primitive| {
                primitive.roots(ray).into_iter().flatten().map(move |t| (t, primitive))
            })
            .filter(move |&(t, _)| t > after && t < before)
    }

    /// The smallest root beyond `after`; of equal ones the first primitive's.
    #[must_use]
    pub fn nearest(&self, ray: &Ray, after: f64) -> Option<(f64, &Primitive)> {
        self.hits(ray, after, f64::INFINITY).min_by(|(a, _), (b, _)| a.total_cmp(b))
    }

    // Shading

    fn surface(&self, seen: &Seen<'_>) -> DVec3 {
        let ambient = seen.material.ambient * seen.material.color;
        ambient + self.scene.lights.iter().map(|light| self.lit(seen, light)).sum::<DVec3>()
    }

    /// The colour that one light adds.
    fn lit(&self, &Seen { point, n, d, material, at_point }: &Seen<'_>, light: &Light) -> DVec3 {
        let to_light = light.position - point;
        let at_light = negligible(light.position, point);
        // A light at the point itself, or elsewhere in a flat surface, has no effect either.
        if n.dot(to_light) <= at_light {
            return DVec3::ZERO;
        }
        let (l, distance) = (to_light.normalize(), to_light.length());
        let shadow = Ray { origin: point, direction: l };
        if self.hits(&shadow, at_point, distance - at_light).next().is_some() {
            return DVec3::ZERO;
        }
        let m = 2.0 * n.dot(l) * n - l;
        let highlight = m.dot(-d).max(0.0).powi(material.shininess as i32);
        light.power
            * light.color
            * (material.diffuse * n.dot(l) * material.color + material.specular * highlight)
    }

    // Reflection

    /// The colour that a ray of unit direction brings, of hits beyond `after`.
    #[must_use]
    pub fn trace(&self, ray: &Ray, after: f64, bounces: u32) -> DVec3 {
        let Some((t, primitive)) = self.nearest(ray, after) else {
            return self.scene.render.background;
        };
        let (point, d) = (ray.at(t), ray.direction);
        let geometric = primitive.normal(point);
        let n = if geometric.dot(d) > 0.0 { -geometric } else { geometric };
        let material = &self.scene.materials[primitive.material()];
        let at_point = negligible(ray.origin, point);
        let surface = self.surface(&Seen { point, n, d, material, at_point });
        let k = material.reflection;
        if k == 0.0 {
            surface
        } else if bounces == self.scene.render.max_reflections {
            (1.0 - k) * surface
        } else {
            let mirrored = Ray { origin: point, direction: d - 2.0 * n.dot(d) * n };
            (1.0 - k) * surface + k * self.trace(&mirrored, at_point, bounces + 1)
        }
    }

    // Anti-aliasing

    /// The colour of pixel `(i, j)`.
    #[must_use]
    pub fn pixel(&self, i: u32, j: u32, width: u32, height: u32) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for Sample { dx, dy, weight } in samples(self.scene.render.antialiasing) {
            let (x, y) = (f64::from(i) + 0.5 + dx, f64::from(j) + 0.5 + dy);
            sum +=
                weight * self.trace(&primary_ray(&self.scene.camera, x, y, width, height), 0.0, 0);
        }
        sum
    }
}

/// One ray of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Offset to the right of the pixel's centre, in pixels.
    pub dx: f64,
    /// Offset downwards from the pixel's centre, in pixels.
    pub dy: f64,
    /// Its share of the pixel; a pixel's shares sum to 1.
    pub weight: f64,
}

/// The samples of every pixel at this lattice density.
#[must_use]
pub fn samples(density: u32) -> Vec<Sample> {
    if density == 0 {
        return vec![Sample { dx: 0.0, dy: 0.0, weight: 1.0 }];
    }
    let mut samples = Vec::new();
    for row in 0..=2 * density {
        for column in 0..=2 * density {
            let [dx, dy] =
                [column, row].map(|k| (f64::from(k) - f64::from(density)) / f64::from(density));
            samples.push(Sample { dx, dy, weight: (-(dx * dx + dy * dy) / 0.64).exp() });
        }
    }
    let total: f64 = samples.iter().map(|sample| sample.weight).sum();
    for sample in &mut samples {
        sample.weight /= total;
    }
    samples
}
