//! The places where the report that this project starts from is wrong, as cases with answers.
//!
//! The answers were computed apart from any code here, to 50 digits, from the decimals as they
//! are written, and rounded to `f64`. The lab report's eye stands at (0, 0, -2).

use crate::model::{Primitive, Ray};
use crate::scenes::{cylinder, looking, plane, sphere, triangle, with};
use glam::{DVec3, dvec3 as v};
use rayweave_core::Scene;

/// One ray against one primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCase {
    /// The name of the case.
    pub name: &'static str,
    /// The claim of the report and its result here; in brackets, a claim near it that is right.
    pub report: &'static str,
    /// The only primitive of the scene, in material 0.
    pub primitive: Primitive,
    /// The ray, whose direction is not of length 1 in general.
    pub ray: Ray,
    /// The right answer; `None` is a miss.
    pub expected: Option<Hit>,
}

/// The right answer to a ray that hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance in units of the ray's direction.
    pub t: f64,
    /// The point.
    pub point: DVec3,
    /// The normal, of length 1 and turned against the ray; for a tangent, outwards.
    pub normal: DVec3,
}

/// An image of one pixel, without anti-aliasing.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadingCase {
    /// The name of the case.
    pub name: &'static str,
    /// The claim of the report and its result here.
    pub report: &'static str,
    /// The scene. Its camera looks at the point in question.
    pub scene: Scene,
    /// The right colour of the only pixel.
    pub expected: DVec3,
}

/// The lab report's slips about a hit.
pub const RAYS: [RayCase; 25] = [
    RayCase {
        name: "sphere without its centre: a miss",
        report: "delta = 4<P,u>^2 - 4<u,u><P, P - r^2>: 3.24 and a hit at t = 1.1, \
                 but delta is -1.76",
        primitive: sphere(v(-0.5, 1.0, 2.0), 0.9),
        ray: ray(v(0.0, 0.0, -2.0), v(0.0, 0.0, 1.0)),
        expected: None,
    },
    RayCase {
        name: "sphere without its centre: a hit",
        report: "delta = 4<P,u>^2 - 4<u,u><P, P - r^2>, with the centre missing",
        primitive: sphere(v(-0.5, 1.0, 2.0), 0.9),
        ray: ray(v(0.0, 0.0, -2.0), v(-0.5, 1.0, 4.0)),
        expected: hit(
            0.7833054644456154,
            v(-0.3916527322228077, 0.7833054644456154, 1.1332218577824618),
            v(0.1203858530857692, -0.2407717061715384, -0.9630868246861536),
        ),
    },
    RayCase {
        name: "far sphere",
        report: "delta = 0 is tangency: in 32 bits delta is 0 instead of 4 here, and t = 10000",
        primitive: sphere(v(0.0, 0.0, 1e4), 1.0),
        ray: ray(DVec3::ZERO, v(0.0, 0.0, 1.0)),
        expected: hit(9999.0, v(0.0, 0.0, 9999.0), v(0.0, 0.0, -1.0)),
    },
    RayCase {
        name: "tangent",
        report: "delta = 0 is tangency: it hits, but no case of its own is needed",
        primitive: sphere(v(1.0, 0.0, 5.0), 1.0),
        ray: ray(DVec3::ZERO, v(0.0, 0.0, 1.0)),
        expected: hit(5.0, v(0.0, 0.0, 5.0), v(-1.0, 0.0, 0.0)),
    },
    RayCase {
        name: "tangent behind",
        report: "the branch for delta = 0 does not test the sign: t = -5 is the nearest hit",
        primitive: sphere(v(0.0, 1.0, -5.0), 1.0),
        ray: ray(DVec3::ZERO, v(0.0, 0.0, 1.0)),
        expected: None,
    },
    RayCase {
        name: "from inside a sphere",
        report: "(the smaller root, -3, is behind: the other one is the hit)",
        primitive: sphere(DVec3::ZERO, 2.0),
        ray: ray(v(0.0, 0.0, 1.0), v(0.0, 0.0, 1.0)),
        expected: hit(1.0, v(0.0, 0.0, 2.0), v(0.0, 0.0, -1.0)),
    },
    RayCase {
        name: "nearly parallel to a plane",
        report: "parallel if and only if <u,n> = 0: as luck has it, in floats; this ray is not",
        primitive: plane(v(0.0, 1.0, 0.0), v(0.0, 1.0, 0.0)),
        ray: ray(DVec3::ZERO, v(1.0, 1e-10, 0.0)),
        expected: hit(1e10, v(1e10, 1.0, 0.0), v(0.0, -1.0, 0.0)),
    },
    RayCase {
        name: "parallel to a plane",
        report: "parallel if and only if <u,n> = 0: as luck has it, in floats; this ray is",
        primitive: plane(v(0.0, 1.0, 0.0), v(1.0, 1.0, 0.0)),
        ray: ray(DVec3::ZERO, v(1.0, -1.0, 0.0)),
        expected: None,
    },
    RayCase {
        name: "in a plane",
        report: "parallel if and only if <u,n> = 0: here the numerator is 0 too",
        primitive: plane(DVec3::ZERO, v(0.0, 1.0, 0.0)),
        ray: ray(v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0)),
        expected: None,
    },
    RayCase {
        name: "plane's point far aside",
        report: "t is the distance to the plane's point: 150.02, but the hit is 5.10 away",
        primitive: plane(v(150.0, 1.0, 0.0), v(0.0, 1.0, 0.0)),
        ray: ray(v(0.0, 0.0, -2.0), v(0.0, 1.0, 5.0)),
        expected: hit(1.0, v(0.0, 1.0, 3.0), v(0.0, -1.0, 0.0)),
    },
    RayCase {
        name: "cylinder's axis",
        report: "x^2 + y^2 = r^2: then this ray would go along the axis and miss",
        primitive: cylinder(v(0.0, -1.0, 0.0), 2.0, 1.0),
        ray: ray(v(0.0, 0.0, -5.0), v(0.0, 0.0, 1.0)),
        expected: hit(4.0, v(0.0, 0.0, -1.0), v(0.0, 0.0, -1.0)),
    },
    RayCase {
        name: "cylinder's radius: a miss",
        report: "C ends in - r, not - r^2: a hit 6.822 away, but the axis is .1987 from the ray",
        primitive: cylinder(v(-1.0, -1.0, 5.0), 3.0, 0.1),
        ray: ray(v(0.0, 0.0, -2.0), v(-0.8, 0.0, 7.0)),
        expected: None,
    },
    RayCase {
        name: "cylinder's radius: a hit",
        report: "C ends in - r, not - r^2: the wall stands at the square root of the radius",
        primitive: cylinder(v(-1.0, -1.0, 5.0), 3.0, 0.1),
        ray: ray(v(0.0, 0.0, -2.0), v(-1.0, 0.0, 7.0)),
        expected: hit(
            0.9858578643762691,
            v(-0.9858578643762691, 0.0, 4.901005050633883),
            v(0.1414213562373095, 0.0, -0.9899494936611666),
        ),
    },
    RayCase {
        name: "far wall through the open end",
        report: "the nearest root, then its height: a miss, but the far wall is 4.472 away",
        primitive: cylinder(DVec3::ZERO, 1.0, 1.0),
        ray: ray(v(-3.0, 2.5, 0.0), v(2.0, -1.0, 0.0)),
        expected: hit(2.0, v(1.0, 0.5, 0.0), v(-1.0, 0.0, 0.0)),
    },
    RayCase {
        name: "along a cylinder's axis",
        report: "A = 0 is not handled: t = 0/0",
        primitive: cylinder(DVec3::ZERO, 1.0, 1.0),
        ray: ray(v(0.5, 5.0, 0.0), v(0.0, -1.0, 0.0)),
        expected: None,
    },
    RayCase {
        name: "along a cylinder's wall",
        report: "A = 0 is not handled: t = 0/0, and this ray lies in the wall",
        primitive: cylinder(DVec3::ZERO, 1.0, 1.0),
        ray: ray(v(1.0, 5.0, 0.0), v(0.0, -1.0, 0.0)),
        expected: None,
    },
    RayCase {
        name: "skew triangle's centroid",
        report: "AB, AC, n are the rows of the basis matrix: (.717, 2.202, -1.196), rejected",
        primitive: triangle(SKEW),
        ray: ray(v(0.0, 0.0, -2.0), v(11.0, 8.0, 70.0)),
        expected: hit(1.0 / 15.0, v(11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0), SKEW_NORMAL),
    },
    RayCase {
        name: "right triangle's centroid",
        report: "AB, AC, n are the rows of the basis matrix: no difference, it is symmetric",
        primitive: triangle(RIGHT),
        ray: ray(v(0.0, 0.0, -2.0), v(1.0, 1.0, 12.0)),
        expected: hit(1.0 / 3.0, v(1.0 / 3.0, 1.0 / 3.0, 2.0), v(0.0, 0.0, -1.0)),
    },
    RayCase {
        name: "triangle from its corner",
        report: "OM where AM is meant: (-1.667, .583, -.354), rejected",
        primitive: triangle([v(0.5, 1.0, 2.0), v(0.0, 0.5, 1.0), v(-0.5, 0.0, 2.0)]),
        ray: ray(v(0.0, 0.0, -2.0), v(0.0, 3.0, 22.0)),
        expected: hit(
            1.0 / 6.0,
            v(0.0, 0.5, 5.0 / 3.0),
            v(std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2, 0.0),
        ),
    },
    RayCase {
        name: "triangle the other way round",
        report: "n = AC x AB against <AB,AM> for AB x AM: every product is negative, \
                 all is rejected",
        primitive: triangle(TURNED),
        ray: ray(v(0.0, 0.0, -2.0), v(11.0, 8.0, 70.0)),
        expected: hit(1.0 / 15.0, v(11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0), SKEW_NORMAL),
    },
    RayCase {
        name: "triangle from behind",
        report: "normals are not turned towards the viewer",
        primitive: triangle(RIGHT),
        ray: ray(v(0.25, 0.25, 6.0), v(0.0, 0.0, -1.0)),
        expected: hit(4.0, v(0.25, 0.25, 2.0), v(0.0, 0.0, 1.0)),
    },
    RayCase {
        name: "triangle's edge",
        report: "(one of the three products is 0: the edges belong to the triangle)",
        primitive: triangle(RIGHT),
        ray: ray(v(0.5, 0.5, 0.0), v(0.0, 0.0, 1.0)),
        expected: hit(2.0, v(0.5, 0.5, 2.0), v(0.0, 0.0, -1.0)),
    },
    RayCase {
        name: "beside a triangle's edge",
        report: "(just outside the same edge)",
        primitive: triangle(RIGHT),
        ray: ray(v(0.5, 0.5078125, 0.0), v(0.0, 0.0, 1.0)),
        expected: None,
    },
    RayCase {
        name: "in a triangle's plane",
        report: "parallel if and only if <u,n> = 0: here all three products are 0 too",
        primitive: triangle(RIGHT),
        ray: ray(v(-1.0, 0.25, 2.0), v(1.0, 0.0, 0.0)),
        expected: None,
    },
    RayCase {
        name: "triangle behind",
        report: "(all three products agree, but t = -4)",
        primitive: triangle(RIGHT),
        ray: ray(v(0.25, 0.25, 6.0), v(0.0, 0.0, 1.0)),
        expected: None,
    },
];

/// The lab report's slips about a colour.
#[must_use]
pub fn shadings() -> Vec<ShadingCase> {
    let floor = |point| plane(point, DVec3::Y);
    let (from_side, above) = (v(-4.0, 3.0, 0.0), v(0.0, 10.0, 0.0));
    let from_eye = |light, vertices| {
        let at = v(11.0 / 15.0, 8.0 / 15.0, 8.0 / 3.0);
        with(looking(v(0.0, 0.0, -2.0), at, &[light]), [triangle(vertices)])
    };
    let mirror = |reflection| {
        let mut scene = with(looking(from_side, DVec3::ZERO, &[]), [floor(DVec3::ZERO)]);
        scene.render.background = v(0.2, 0.4, 0.6);
        scene.materials[0].reflection = reflection;
        scene
    };
    let cases = [
        (
            "the lit side of a triangle",
            "normals are not turned towards the viewer: with n = AC x AB, n.l = -.424 and .1 of \
             diffuse",
            from_eye(v(15.0, -10.0, -10.0), TURNED),
            v(0.3910457989369001, 0.03653726902163525, 0.03653726902163525),
        ),
        (
            "the same triangle the other way round",
            "normals are not turned towards the viewer: this one happens to be right",
            from_eye(v(15.0, -10.0, -10.0), SKEW),
            v(0.3910457989369001, 0.03653726902163525, 0.03653726902163525),
        ),
        (
            "a triangle lit from behind",
            "normals are not turned towards the viewer: with n = AC x AB, n.l = .184 and diffuse",
            from_eye(v(-15.0, 10.0, 10.0), SKEW),
            v(0.1, 0.0, 0.0),
        ),
        (
            "a highlight from below the floor",
            "the highlight is not bound to n.l > 0: n.l = -.6, but m.-d = .28",
            with(looking(from_side, DVec3::ZERO, &[v(4.0, -3.0, 0.0)]), [floor(DVec3::ZERO)]),
            v(0.1, 0.0, 0.0),
        ),
        (
            "a ceiling beyond the light",
            "the shadow ray has no end: the light is 23.9 away, the ceiling hit at 45.6",
            with(
                looking(v(0.0, 0.0, -2.0), v(0.0, 1.0, 5.0), &[v(-15.0, -10.0, -10.0)]),
                [floor(v(150.0, 1.0, 0.0)), floor(v(0.0, -20.0, 0.0))],
            ),
            v(0.37620140371033356, 0.0, 0.0),
        ),
        (
            "three lights, all hidden",
            "a hidden light gives colour/10: .3 of red",
            with(
                looking(from_side, DVec3::ZERO, &[above, above + DVec3::X, above + DVec3::Z]),
                [floor(DVec3::ZERO), sphere(v(0.0, 2.0, 0.0), 1.0)],
            ),
            v(0.1, 0.0, 0.0),
        ),
        (
            "the shadow of a tiny sphere",
            "shadow rays start 1e-3 away: beyond a sphere of radius 4e-4",
            with(
                looking(v(4.0, 1.0, 0.0), DVec3::ZERO, &[above]),
                [floor(DVec3::ZERO), sphere(v(0.0, 5e-4, 0.0), 4e-4)],
            ),
            v(0.1, 0.0, 0.0),
        ),
        (
            "a floor far from the origin",
            "shadow rays start 1e-3 away: in 32 bits 32768 + 1e-3 = 32768",
            with(
                looking(v(-4.0, 32771.0, 0.0), v(0.0, 32768.0, 0.0), &[v(0.0, 32778.0, 0.0)]),
                [floor(v(0.0, 32768.0, 0.0))],
            ),
            v(0.844, 0.144, 0.144),
        ),
        (
            "a full mirror",
            "(c + k c') / (1 + k): k = 1 is half a mirror, (.15, .2, .3)",
            mirror(1.0),
            v(0.2, 0.4, 0.6),
        ),
        (
            "a part mirror",
            "(c + k c') / (1 + k) for k = 1/4 is this one with k/(1 + k) = 1/5",
            mirror(0.2),
            v(0.12, 0.08, 0.12),
        ),
    ];
    cases
        .map(|(name, report, scene, expected)| ShadingCase { name, report, scene, expected })
        .into()
}

/// The lab report's triangle that was "misplaced", its other orientation, and its normal.
const SKEW: [DVec3; 3] = [v(-0.5, 1.0, 3.0), v(1.0, 0.8, 2.5), v(1.7, -0.2, 2.5)];
const TURNED: [DVec3; 3] = [SKEW[0], SKEW[2], SKEW[1]];
const SKEW_NORMAL: DVec3 = v(-0.335419420785874, -0.2347935945501118, -0.9123408245375774);
/// A right triangle.
const RIGHT: [DVec3; 3] = [v(0.0, 0.0, 2.0), v(1.0, 0.0, 2.0), v(0.0, 1.0, 2.0)];

const fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction }
}

const fn hit(t: f64, point: DVec3, normal: DVec3) -> Option<Hit> {
    Some(Hit { t, point, normal })
}
