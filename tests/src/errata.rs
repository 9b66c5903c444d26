//! Where the report that this project starts from is wrong, as inputs and right answers.
//!
//! The answers were computed apart from any code here, to 50 digits, from the decimals as they
//! are written, and rounded to `f64`. The report's eye stands at (0, 0, -2).

use crate::model::{Primitive, Ray};
use glam::DVec3;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Scene, Sphere, Triangle,
};

/// One ray against one primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCase {
    /// Which one it is.
    pub name: &'static str,
    /// What the report says and what comes of it here; in brackets, what is near it and right.
    pub report: &'static str,
    /// The only thing there is; its material is number 0.
    pub primitive: Primitive,
    /// Its direction is not of length 1 in general.
    pub ray: Ray,
    /// The right answer; `None` is a miss.
    pub expected: Option<Hit>,
}

/// Where a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// In units of the ray's direction.
    pub t: f64,
    /// Where.
    pub point: DVec3,
    /// Of length 1 and turned against the ray; for a tangent, outwards.
    pub normal: DVec3,
}

impl RayCase {
    /// How far the right hit is from the ray's origin, in scene units.
    #[must_use]
    pub fn distance(&self) -> Option<f64> {
        self.expected.map(|hit| hit.t * self.ray.direction.length())
    }
}

/// An image of one pixel, without anti-aliasing.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadingCase {
    /// Which one it is.
    pub name: &'static str,
    /// What the report says, and what comes of it here.
    pub report: &'static str,
    /// The camera looks at the point in question.
    pub scene: Scene,
    /// The right colour of the only pixel.
    pub expected: [f64; 3],
}

/// How many rays a whole image needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeCase {
    /// What the report says, and what comes of it here.
    pub report: &'static str,
    /// The image's size in pixels.
    pub size: (u32, u32),
    /// Its lattice density.
    pub antialiasing: u32,
    /// The number of different points that its samples fall on.
    pub rays: u64,
}

/// The report's slips about a hit.
pub const RAYS: [RayCase; 25] = [
    RayCase {
        name: "sphere without its centre: a miss",
        report: "delta = 4<P,u>^2 - 4<u,u><P, P - r^2>: 3.24 and a hit at t = 1.1, but delta is -1.76",
        primitive: sphere([-0.5, 1.0, 2.0], 0.9),
        ray: ray([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]),
        expected: None,
    },
    RayCase {
        name: "sphere without its centre: a hit",
        report: "delta = 4<P,u>^2 - 4<u,u><P, P - r^2>, with the centre missing",
        primitive: sphere([-0.5, 1.0, 2.0], 0.9),
        ray: ray([0.0, 0.0, -2.0], [-0.5, 1.0, 4.0]),
        expected: hit(
            0.7833054644456154,
            [-0.3916527322228077, 0.7833054644456154, 1.1332218577824618],
            [0.1203858530857692, -0.2407717061715384, -0.9630868246861536],
        ),
    },
    RayCase {
        name: "far sphere",
        report: "delta = 0 is tangency: in 32 bits delta is 0 instead of 4 here, and t = 10000",
        primitive: sphere([0.0, 0.0, 1e4], 1.0),
        ray: ray([0.0; 3], [0.0, 0.0, 1.0]),
        expected: hit(9999.0, [0.0, 0.0, 9999.0], [0.0, 0.0, -1.0]),
    },
    RayCase {
        name: "tangent",
        report: "delta = 0 is tangency: it hits, but no case of its own is needed",
        primitive: sphere([1.0, 0.0, 5.0], 1.0),
        ray: ray([0.0; 3], [0.0, 0.0, 1.0]),
        expected: hit(5.0, [0.0, 0.0, 5.0], [-1.0, 0.0, 0.0]),
    },
    RayCase {
        name: "tangent behind",
        report: "the branch for delta = 0 does not test the sign: t = -5 is the nearest hit",
        primitive: sphere([0.0, 1.0, -5.0], 1.0),
        ray: ray([0.0; 3], [0.0, 0.0, 1.0]),
        expected: None,
    },
    RayCase {
        name: "from inside a sphere",
        report: "(the smaller root, -3, is behind: the other one is the hit)",
        primitive: sphere([0.0; 3], 2.0),
        ray: ray([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]),
        expected: hit(1.0, [0.0, 0.0, 2.0], [0.0, 0.0, -1.0]),
    },
    RayCase {
        name: "nearly parallel to a plane",
        report: "parallel if and only if <u,n> = 0: as luck has it, in floats; this ray is not",
        primitive: plane([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
        ray: ray([0.0; 3], [1.0, 1e-10, 0.0]),
        expected: hit(1e10, [1e10, 1.0, 0.0], [0.0, -1.0, 0.0]),
    },
    RayCase {
        name: "parallel to a plane",
        report: "parallel if and only if <u,n> = 0: as luck has it, in floats; this ray is",
        primitive: plane([0.0, 1.0, 0.0], [1.0, 1.0, 0.0]),
        ray: ray([0.0; 3], [1.0, -1.0, 0.0]),
        expected: None,
    },
    RayCase {
        name: "in a plane",
        report: "parallel if and only if <u,n> = 0: here the numerator is 0 too",
        primitive: plane([0.0; 3], [0.0, 1.0, 0.0]),
        ray: ray([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        expected: None,
    },
    RayCase {
        name: "plane's point far aside",
        report: "t is the distance to the plane's point: 150.02, but the hit is 5.10 away",
        primitive: plane([150.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
        ray: ray([0.0, 0.0, -2.0], [0.0, 1.0, 5.0]),
        expected: hit(1.0, [0.0, 1.0, 3.0], [0.0, -1.0, 0.0]),
    },
    RayCase {
        name: "cylinder's axis",
        report: "x^2 + y^2 = r^2: then this ray would go along the axis and miss",
        primitive: cylinder([0.0, -1.0, 0.0], 1.0, 1.0),
        ray: ray([0.0, 0.0, -5.0], [0.0, 0.0, 1.0]),
        expected: hit(4.0, [0.0, 0.0, -1.0], [0.0, 0.0, -1.0]),
    },
    RayCase {
        name: "cylinder's radius: a miss",
        report: "C ends in - r, not - r^2: a hit 6.822 away, but the axis is .1987 from the ray",
        primitive: cylinder([-1.0, -1.0, 5.0], 2.0, 0.1),
        ray: ray([0.0, 0.0, -2.0], [-0.8, 0.0, 7.0]),
        expected: None,
    },
    RayCase {
        name: "cylinder's radius: a hit",
        report: "C ends in - r, not - r^2: the wall stands at the square root of the radius",
        primitive: cylinder([-1.0, -1.0, 5.0], 2.0, 0.1),
        ray: ray([0.0, 0.0, -2.0], [-1.0, 0.0, 7.0]),
        expected: hit(
            0.9858578643762691,
            [-0.9858578643762691, 0.0, 4.901005050633883],
            [0.1414213562373095, 0.0, -0.9899494936611666],
        ),
    },
    RayCase {
        name: "far wall through the open end",
        report: "the nearest root, then its height: a miss, but the far wall is 4.472 away",
        primitive: cylinder([0.0; 3], 1.0, 1.0),
        ray: ray([-3.0, 2.5, 0.0], [2.0, -1.0, 0.0]),
        expected: hit(2.0, [1.0, 0.5, 0.0], [-1.0, 0.0, 0.0]),
    },
    RayCase {
        name: "along a cylinder's axis",
        report: "A = 0 is not handled: t = 0/0",
        primitive: cylinder([0.0; 3], 1.0, 1.0),
        ray: ray([0.5, 5.0, 0.0], [0.0, -1.0, 0.0]),
        expected: None,
    },
    RayCase {
        name: "along a cylinder's wall",
        report: "A = 0 is not handled: t = 0/0, and this ray lies in the wall",
        primitive: cylinder([0.0; 3], 1.0, 1.0),
        ray: ray([1.0, 5.0, 0.0], [0.0, -1.0, 0.0]),
        expected: None,
    },
    RayCase {
        name: "skew triangle's centroid",
        report: "AB, AC, n are the rows of the basis matrix: (.717, 2.202, -1.196), rejected",
        primitive: triangle(SKEW),
        ray: ray([0.0, 0.0, -2.0], [11.0, 8.0, 70.0]),
        expected: hit(1.0 / 15.0, [11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0], SKEW_NORMAL),
    },
    RayCase {
        name: "right triangle's centroid",
        report: "AB, AC, n are the rows of the basis matrix: no difference, it is symmetric",
        primitive: triangle([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]),
        ray: ray([0.0, 0.0, -2.0], [1.0, 1.0, 12.0]),
        expected: hit(1.0 / 3.0, [1.0 / 3.0, 1.0 / 3.0, 2.0], [0.0, 0.0, -1.0]),
    },
    RayCase {
        name: "triangle from its corner",
        report: "OM where AM is meant: (-1.667, .583, -.354), rejected",
        primitive: triangle([[0.5, 1.0, 2.0], [0.0, 0.5, 1.0], [-0.5, 0.0, 2.0]]),
        ray: ray([0.0, 0.0, -2.0], [0.0, 3.0, 22.0]),
        expected: hit(
            1.0 / 6.0,
            [0.0, 0.5, 5.0 / 3.0],
            [std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2, 0.0],
        ),
    },
    RayCase {
        name: "triangle the other way round",
        report: "n = AC x AB against <AB,AM> for AB x AM: every product is negative, all is rejected",
        primitive: triangle([SKEW[0], SKEW[2], SKEW[1]]),
        ray: ray([0.0, 0.0, -2.0], [11.0, 8.0, 70.0]),
        expected: hit(1.0 / 15.0, [11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0], SKEW_NORMAL),
    },
    RayCase {
        name: "triangle from behind",
        report: "normals are not turned towards the viewer",
        primitive: triangle([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]),
        ray: ray([0.25, 0.25, 6.0], [0.0, 0.0, -1.0]),
        expected: hit(4.0, [0.25, 0.25, 2.0], [0.0, 0.0, 1.0]),
    },
    RayCase {
        name: "triangle's edge",
        report: "(one of the three products is 0: the edges belong to the triangle)",
        primitive: triangle([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]),
        ray: ray([0.5, 0.5, 0.0], [0.0, 0.0, 1.0]),
        expected: hit(2.0, [0.5, 0.5, 2.0], [0.0, 0.0, -1.0]),
    },
    RayCase {
        name: "beside a triangle's edge",
        report: "(just outside the same edge)",
        primitive: triangle([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]),
        ray: ray([0.5, 0.5078125, 0.0], [0.0, 0.0, 1.0]),
        expected: None,
    },
    RayCase {
        name: "in a triangle's plane",
        report: "parallel if and only if <u,n> = 0: here all three products are 0 too",
        primitive: triangle([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]),
        ray: ray([-1.0, 0.25, 2.0], [1.0, 0.0, 0.0]),
        expected: None,
    },
    RayCase {
        name: "triangle behind",
        report: "(all three products agree, but t = -4)",
        primitive: triangle([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]),
        ray: ray([0.25, 0.25, 6.0], [0.0, 0.0, 1.0]),
        expected: None,
    },
];

/// The report's 5 x 5 grid on its own image.
pub const LATTICE: LatticeCase = LatticeCase {
    report: "5 x 5 rays for each of 500 x 500 pixels, 6,250,000: four of neighbours' fall together",
    size: (500, 500),
    antialiasing: 2,
    rays: 1003 * 1003,
};

/// The report's slips about a colour.
#[must_use]
pub fn shadings() -> Vec<ShadingCase> {
    let floor = plane_at([0.0; 3]);
    let ball = |center, radius| Sphere { center: DVec3::from_array(center), radius, material: 0 };
    let from_side = [-4.0, 3.0, 0.0];
    let skew = Triangle { vertices: SKEW.map(DVec3::from_array), material: 0 };
    let from_eye = |lights: &[[f64; 3]]| {
        looking([0.0, 0.0, -2.0], [11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0], lights)
    };
    let mirror = |reflection| {
        let mut scene = looking(from_side, [0.0; 3], &[]);
        scene.render.background = DVec3::new(0.2, 0.4, 0.6);
        scene.materials[0].reflection = reflection;
        Scene { planes: vec![floor], ..scene }
    };
    vec![
        ShadingCase {
            name: "the lit side of a triangle",
            report: "normals are not turned towards the viewer: with n = AC x AB, n.l = -.424 and .1 of diffuse",
            scene: Scene {
                triangles: vec![Triangle {
                    vertices: [SKEW[0], SKEW[2], SKEW[1]].map(DVec3::from_array),
                    material: 0,
                }],
                ..from_eye(&[[15.0, -10.0, -10.0]])
            },
            expected: [0.3910457989369001, 0.03653726902163525, 0.03653726902163525],
        },
        ShadingCase {
            name: "the same triangle the other way round",
            report: "normals are not turned towards the viewer: this one happens to be right",
            scene: Scene { triangles: vec![skew], ..from_eye(&[[15.0, -10.0, -10.0]]) },
            expected: [0.3910457989369001, 0.03653726902163525, 0.03653726902163525],
        },
        ShadingCase {
            name: "a triangle lit from behind",
            report: "normals are not turned towards the viewer: with n = AC x AB, n.l = .184 and diffuse",
            scene: Scene { triangles: vec![skew], ..from_eye(&[[-15.0, 10.0, 10.0]]) },
            expected: [0.1, 0.0, 0.0],
        },
        ShadingCase {
            name: "a highlight from below the floor",
            report: "the highlight is not bound to n.l > 0: n.l = -.6, but m.-d = .28",
            scene: Scene {
                planes: vec![floor],
                ..looking(from_side, [0.0; 3], &[[4.0, -3.0, 0.0]])
            },
            expected: [0.1, 0.0, 0.0],
        },
        ShadingCase {
            name: "a ceiling beyond the light",
            report: "the shadow ray has no end: the light is 23.9 away, the ceiling hit at 45.6",
            scene: Scene {
                planes: vec![plane_at([150.0, 1.0, 0.0]), plane_at([0.0, -20.0, 0.0])],
                ..looking([0.0, 0.0, -2.0], [0.0, 1.0, 5.0], &[[-15.0, -10.0, -10.0]])
            },
            expected: [0.37620140371033356, 0.0, 0.0],
        },
        ShadingCase {
            name: "three lights, all hidden",
            report: "a hidden light gives colour/10: .3 of red",
            scene: Scene {
                planes: vec![floor],
                spheres: vec![ball([0.0, 2.0, 0.0], 1.0)],
                ..looking(
                    from_side,
                    [0.0; 3],
                    &[[0.0, 10.0, 0.0], [1.0, 10.0, 0.0], [0.0, 10.0, 1.0]],
                )
            },
            expected: [0.1, 0.0, 0.0],
        },
        ShadingCase {
            name: "the shadow of a tiny sphere",
            report: "shadow rays start 1e-3 away: beyond a sphere of radius 4e-4",
            scene: Scene {
                planes: vec![floor],
                spheres: vec![ball([0.0, 5e-4, 0.0], 4e-4)],
                ..looking([4.0, 1.0, 0.0], [0.0; 3], &[[0.0, 10.0, 0.0]])
            },
            expected: [0.1, 0.0, 0.0],
        },
        ShadingCase {
            name: "a floor far from the origin",
            report: "shadow rays start 1e-3 away: in 32 bits 32768 + 1e-3 = 32768",
            scene: Scene {
                planes: vec![plane_at([0.0, 32768.0, 0.0])],
                ..looking([-4.0, 32771.0, 0.0], [0.0, 32768.0, 0.0], &[[0.0, 32778.0, 0.0]])
            },
            expected: [0.844, 0.144, 0.144],
        },
        ShadingCase {
            name: "a full mirror",
            report: "(c + k c') / (1 + k): k = 1 is half a mirror, (.15, .2, .3)",
            scene: mirror(1.0),
            expected: [0.2, 0.4, 0.6],
        },
        ShadingCase {
            name: "a part mirror",
            report: "(c + k c') / (1 + k) for k = 1/4 is this one with k/(1 + k) = 1/5",
            scene: mirror(0.2),
            expected: [0.12, 0.08, 0.12],
        },
    ]
}

/// The report's triangle that was "misplaced".
const SKEW: [[f64; 3]; 3] = [[-0.5, 1.0, 3.0], [1.0, 0.8, 2.5], [1.7, -0.2, 2.5]];
const SKEW_NORMAL: [f64; 3] = [-0.335419420785874, -0.2347935945501118, -0.9123408245375774];

const fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray { origin: DVec3::from_array(origin), direction: DVec3::from_array(direction) }
}

const fn hit(t: f64, point: [f64; 3], normal: [f64; 3]) -> Option<Hit> {
    Some(Hit { t, point: DVec3::from_array(point), normal: DVec3::from_array(normal) })
}

const fn plane(point: [f64; 3], normal: [f64; 3]) -> Primitive {
    Primitive::Plane(Plane {
        point: DVec3::from_array(point),
        normal: DVec3::from_array(normal),
        material: 0,
    })
}

const fn sphere(center: [f64; 3], radius: f64) -> Primitive {
    Primitive::Sphere(Sphere { center: DVec3::from_array(center), radius, material: 0 })
}

const fn triangle([a, b, c]: [[f64; 3]; 3]) -> Primitive {
    let vertices = [DVec3::from_array(a), DVec3::from_array(b), DVec3::from_array(c)];
    Primitive::Triangle(Triangle { vertices, material: 0 })
}

const fn cylinder(bottom: [f64; 3], top: f64, radius: f64) -> Primitive {
    let [x, _, z] = bottom;
    Primitive::Cylinder(Cylinder {
        bottom: DVec3::from_array(bottom),
        top: DVec3::new(x, top, z),
        radius,
        material: 0,
    })
}

fn plane_at(point: [f64; 3]) -> Plane {
    Plane { point: DVec3::from_array(point), normal: DVec3::Y, material: 0 }
}

/// A scene with nothing in it but lights, and red with the model's defaults.
fn looking(from: [f64; 3], at: [f64; 3], lights: &[[f64; 3]]) -> Scene {
    let light =
        |&position| Light { position: DVec3::from_array(position), color: DVec3::ONE, power: 1.0 };
    Scene {
        camera: Camera {
            position: DVec3::from_array(from),
            look_at: DVec3::from_array(at),
            up: DVec3::Y,
            focal_length: 1.0,
            screen_width: 1.0,
        },
        render: RenderSettings { antialiasing: 0, ..RenderSettings::default() },
        lights: lights.iter().map(light).collect(),
        materials: vec![Material::new(DVec3::X)],
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        cylinders: Vec::new(),
    }
}
