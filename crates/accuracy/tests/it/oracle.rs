//! The oracle on cases that can be computed by hand.

use rayweave_accuracy::oracle::INFINITE;
use rayweave_accuracy::{ExactAnswer, Expect, Primitive, Ray, answer};

fn trace(primitive: &Primitive, origin: [f32; 3], direction: [f32; 3]) -> ExactAnswer {
    answer(primitive, &Ray { origin, direction })
}

/// Asserts a hit at these numbers, each to 40 digits, and returns whether it is decidable.
#[track_caller]
fn assert_hit(answer: &ExactAnswer, t: &str, point: [&str; 3], normal: [&str; 3]) -> bool {
    let number = |text: &str| text.parse().expect("a number");
    let expected = Expect::Hit {
        t: number(t),
        point: Box::new(point.map(number)),
        normal: Box::new(normal.map(number)),
    };
    assert_eq!(answer.expect, expected);
    assert_eq!(answer.reason, "");
    answer.decidable
}

/// Asserts a miss for this reason, and returns whether it is decidable.
#[track_caller]
fn assert_miss(answer: &ExactAnswer, reason: &str) -> bool {
    assert_eq!((&answer.expect, answer.reason, answer.cond), (&Expect::Miss, reason, 0.0));
    answer.decidable
}

/// Traces a ray, asserts a miss for this reason, and returns whether it is decidable.
#[track_caller]
fn misses(primitive: &Primitive, origin: [f32; 3], direction: [f32; 3], reason: &str) -> bool {
    assert_miss(&trace(primitive, origin, direction), reason)
}

const SQRT_HALF: &str = "0.7071067811865475244008443621048490392848";

#[test]
fn plane() {
    let floor = Primitive::Plane { point: [5.0, 1.0, -7.0], normal: [0.0, 2.0, 0.0] };
    let down = trace(&floor, [3.0, 4.0, 5.0], [0.5, -2.0, 0.0]);
    assert!(assert_hit(&down, "1.5", ["3.75", "1", "5"], ["0", "1", "0"]));
    // t = (q - o).n / d.n = -6 / -4: both without cancellation, so the errors of both add up.
    assert_eq!(down.cond, 2.0);
    assert!(misses(&floor, [3.0, 4.0, 5.0], [0.5, 2.0, 0.0], "behind"));
    assert!(misses(&floor, [3.0, 4.0, 5.0], [1.0, 0.0, 1.0], "parallel"));
    // In the plane: no hit, though every point of the ray is one.
    assert!(misses(&floor, [3.0, 1.0, 5.0], [1.0, 0.0, 1.0], "parallel"));
    // On the plane: t = 0.
    assert!(misses(&floor, [3.0, 1.0, 5.0], [1.0, -1.0, 1.0], "behind"));
    // From below, at a slanted plane: the normal stays as given.
    let slope = Primitive::Plane { point: [0.0, 0.0, 0.0], normal: [1.0, 1.0, 0.0] };
    let up = trace(&slope, [-1.0, -1.0, 0.0], [0.0, 1.0, 0.0]);
    assert!(assert_hit(&up, "2", ["-1", "1", "0"], [SQRT_HALF, SQRT_HALF, "0"]));
    let flat = Primitive::Plane { point: [0.0; 3], normal: [0.0; 3] };
    assert!(misses(&flat, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], "zero normal"));
}

#[test]
fn a_rounded_boundary_is_not_decidable_and_an_exact_one_is() {
    // d.n = 1/2 - (1/2 + u) + u = 0 with u = 2^-23, and no sum of these terms in f32 rounds.
    let ulp = f32::EPSILON;
    let exact = Primitive::Plane { point: [0.0, 0.0, 1.0], normal: [1.0, 1.0, 1.0] };
    assert!(misses(&exact, [0.0; 3], [0.5, -0.5 - ulp, ulp], "parallel"));
    // (1 + u)^2 - (1 + 2 u) - u^2 = 0, but f32 rounds the square.
    let rounded = Primitive::Plane { point: [0.0, 0.0, 1.0], normal: [1.0 + ulp, -1.0, 1.0] };
    let answer = trace(&rounded, [0.0; 3], [1.0 + ulp, 1.0 + 2.0 * ulp, -ulp * ulp]);
    assert!(!assert_miss(&answer, "parallel"));
    assert_eq!(answer.margin, 0.0);
    // d.n = 2^-30 of terms that sum up to 2 + 2^-30: 2^-31 relative, 2^-8 ulps.
    let near = trace(&exact, [0.0; 3], [1.0, -1.0, 2.0_f32.powi(-30)]);
    assert!(!assert_hit(
        &near,
        "1073741824",
        ["1073741824", "-1073741824", "1"],
        ["0.5773502691896257645091487805019574556476"; 3]
    ));
    assert_eq!(near.margin, 0.003906);
}

#[test]
fn the_least_certain_comparison_decides_how_certain_a_verdict_is() {
    let slope = Primitive::Plane { point: [0.0; 3], normal: [1.0, 1.0, 0.0] };
    // The direction is far from parallel, but the origin is half an ulp from the plane.
    let close = trace(&slope, [1.0, -1.0 + f32::EPSILON, 0.0], [-1.0, -1.0, 0.0]);
    assert!(close.expect.is_hit() && !close.decidable);
    assert_eq!(close.margin, 0.5);
    // 2^23 - (2^23 - 1) - 1 = 0: the sizes sum up to 2^24, which f32 can just count to.
    let count = 8_388_608.0;
    let space = Primitive::Plane { point: [0.0, 0.0, 1.0], normal: [1.0; 3] };
    assert!(misses(&space, [0.0; 3], [count, 1.0 - count, -1.0], "parallel"));
    // Two units more are too much for one of the orders of adding.
    assert!(!misses(&space, [0.0; 3], [count + 1.0, -count, -1.0], "parallel"));
}

#[test]
fn sphere() {
    let ball = Primitive::Sphere { center: [1.0, 0.0, 0.0], radius: 5.0 };
    // 3-4-5: the chord at height 4 reaches from x = -2 to 4.
    let both = trace(&ball, [-8.0, 4.0, 0.0], [2.0, 0.0, 0.0]);
    assert!(assert_hit(&both, "3", ["-2", "4", "0"], ["-0.6", "0.8", "0"]));
    // f = (-9, 4), p = (-3, 4), |p.d| t = 18: (27 + 16 + 18 + 25) / 18.
    assert_eq!(both.cond, 4.778);
    assert!(assert_hit(
        &trace(&ball, [-1.0, 4.0, 0.0], [2.0, 0.0, 0.0]),
        "2.5",
        ["4", "4", "0"],
        ["0.6", "0.8", "0"]
    ));
    assert!(misses(&ball, [4.5, 4.0, 0.0], [2.0, 0.0, 0.0], "behind"));
    assert!(misses(&ball, [-8.0, 5.5, 0.0], [2.0, 0.0, 0.0], "beside"));
    // An irrational root: the chord at height 1 of a unit sphere moved up by half.
    let unit = Primitive::Sphere { center: [0.0, 0.5, 0.0], radius: 1.0 };
    let root = "0.8660254037844386467637231707529361834714";
    let t = "1.133974596215561353236276829247063816529";
    assert!(assert_hit(
        &trace(&unit, [0.0, 1.0, -2.0], [0.0, 0.0, 1.0]),
        t,
        ["0", "1", &format!("-{root}")],
        ["0", "0.5", &format!("-{root}")]
    ));
    let hollow = Primitive::Sphere { center: [0.0; 3], radius: 0.0 };
    assert!(misses(&hollow, [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], "no radius"));
    let inverse = Primitive::Sphere { center: [0.0; 3], radius: -1.0 };
    assert!(misses(&inverse, [0.0, 0.0, -2.0], [0.0, 0.0, 1.0], "no radius"));
}

#[test]
fn a_tangent_touches_a_sphere() {
    let ball = Primitive::Sphere { center: [0.0, 1.0, 0.0], radius: 1.0 };
    let tangent = trace(&ball, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0]);
    assert!(!assert_hit(&tangent, "5", ["0", "0", "0"], ["0", "-1", "0"]));
    assert_eq!((tangent.margin, tangent.cond), (0.0, INFINITE));
    let ulp = f32::EPSILON;
    let over = Primitive::Sphere { center: [0.0, 1.0, 0.0], radius: 1.0 - ulp / 2.0 };
    assert!(!misses(&over, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0], "beside"));
    // Past the point where it touches it does not matter whether it does.
    assert!(misses(&ball, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], "behind"));
}

#[test]
fn a_start_on_the_sphere_hits_only_the_other_side() {
    let ball = Primitive::Sphere { center: [0.0; 3], radius: 5.0 };
    let inward = trace(&ball, [0.0, 3.0, -4.0], [0.0, 0.0, 0.5]);
    assert!(assert_hit(&inward, "16", ["0", "3", "4"], ["0", "0.6", "0.8"]));
    assert!(misses(&ball, [0.0, 3.0, -4.0], [0.0, 0.0, -0.5], "behind"));
    // Almost a tangent: whether it goes in is certain, and then it must come out.
    let shallow = trace(&ball, [0.0, 3.0, -4.0], [0.0, 4.0, 3.0 + 2.0_f32.powi(-10)]);
    assert!(shallow.expect.is_hit() && shallow.decidable);
    // At a right angle to the radius: tangent there, and nothing else.
    assert!(!misses(&ball, [0.0, 3.0, -4.0], [0.0, 4.0, 3.0], "behind"));
}

const TRIANGLE: Primitive =
    Primitive::Triangle { a: [0.0, 0.0, 0.0], b: [4.0, 0.0, 0.0], c: [0.0, 4.0, 0.0] };

#[test]
fn triangle() {
    let above = |x, y| trace(&TRIANGLE, [x, y, 2.0], [0.0, 0.0, -0.5]);
    assert!(assert_hit(&above(1.0, 1.0), "4", ["1", "1", "0"], ["0", "0", "1"]));
    // From below: the same normal.
    let below = trace(&TRIANGLE, [1.0, 1.0, -2.0], [0.0, 0.0, 0.5]);
    assert!(assert_hit(&below, "4", ["1", "1", "0"], ["0", "0", "1"]));
    assert!(assert_miss(&above(3.0, 3.0), "outside"));
    assert!(assert_miss(&above(-1.0, 1.0), "outside"));
    assert!(assert_miss(&above(1.0, -1.0), "outside"));
    assert!(misses(&TRIANGLE, [1.0, 1.0, 2.0], [0.0, 0.0, 0.5], "behind"));
    assert!(misses(&TRIANGLE, [1.0, 1.0, 0.0], [0.0, 1.0, 0.5], "behind"));
}

#[test]
fn edges_and_vertices_belong_to_a_triangle() {
    let above = |x: f32, y: f32| trace(&TRIANGLE, [x, y, 2.0], [0.0, 0.0, -1.0]);
    for (x, y) in [(2.0, 0.0), (0.0, 2.0), (2.0, 2.0), (0.0, 0.0), (4.0, 0.0), (0.0, 4.0)] {
        let answer = above(x, y);
        let point = [&x.to_string(), &y.to_string(), "0"];
        assert!(!assert_hit(&answer, "2", point, ["0", "0", "1"]), "({x}, {y})");
        assert_eq!(answer.margin, 0.0, "({x}, {y})");
    }
    // Past an edge by little more than nothing: decidable where f32 has that little in a
    // coordinate, and not at the slanted edge, where it is a difference of products.
    let tiny = 2.0_f32.powi(-40);
    for (x, y) in [(2.0, -tiny), (-tiny, 2.0), (-tiny, -tiny), (4.0, -tiny)] {
        assert!(assert_miss(&above(x, y), "outside"), "({x}, {y})");
    }
    assert!(!assert_miss(&above(2.0 + 2.0 * f32::EPSILON, 2.0), "outside"));
    // Looking away from it, which side of the edge it is does not matter.
    let away = trace(&TRIANGLE, [2.0 + 2.0 * f32::EPSILON, 2.0, 2.0], [0.0, 0.0, 1.0]);
    assert!(assert_miss(&away, "outside"));
}

#[test]
fn a_ray_in_the_plane_misses_a_triangle() {
    // Through the middle, and along an edge.
    assert!(misses(&TRIANGLE, [-1.0, 1.0, 0.0], [1.0, 0.0, 0.0], "parallel"));
    assert!(misses(&TRIANGLE, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], "parallel"));
    assert!(misses(&TRIANGLE, [1.0, 1.0, 3.0], [1.0, 1.0, 0.0], "parallel"));
    // The normal's products are rounded: certain where the ray passes outside, not in the plane.
    let c = [-1.0 - f32::EPSILON, 1.0 + 3.0 * f32::EPSILON, 0.0];
    let rounded = Primitive::Triangle { a: [0.0; 3], b: [1.0 + f32::EPSILON, 1.0, 0.0], c };
    assert!(misses(&rounded, [-5.0, 50.0, 5.0], [1.0, 0.0, 0.0], "parallel"));
    assert!(!misses(&rounded, [-5.0, 0.5, 0.0], [1.0, 0.0, 0.0], "parallel"));
}

#[test]
fn a_triangle_without_area_is_never_hit() {
    let down = |a, b, c| trace(&Primitive::Triangle { a, b, c }, [1.0, 0.0, 2.0], [0.0, 0.0, -1.0]);
    let (o, x) = ([0.0; 3], [2.0, 0.0, 0.0]);
    for answer in
        [down(o, x, [0.5, 0.0, 0.0]), down(o, x, x), down(o, o, x), down(x, o, x), down(o, o, o)]
    {
        assert!(assert_miss(&answer, "degenerate"));
        assert_eq!(answer.margin, INFINITE);
    }
    // With all the bits of f32 its products are rounded; that is no excuse.
    let (b, c) = ([0.1, 0.3, 0.7], [0.2, 0.6, 1.4]);
    let long = Primitive::Triangle { a: o, b, c };
    assert!(misses(&long, [0.1, 0.3, -1.0], [0.0, 0.0, 1.0], "degenerate"));
    // An area of 2^-149 is one.
    let least = down(o, x, [1.0, f32::from_bits(1), 0.0]);
    assert!(!assert_hit(&least, "2", ["1", "0", "0"], ["0", "0", "1"]));
}

const WALL: Primitive =
    Primitive::Cylinder { bottom: [0.0, -1.0, 0.0], top: [0.0, 1.0, 0.0], radius: 1.0 };

#[test]
fn cylinder() {
    // 3-4-5, with a wall of radius 5 around x = 1.
    let wide = Primitive::Cylinder { bottom: [1.0, 0.0, 0.0], top: [1.0, 9.0, 0.0], radius: 5.0 };
    let near = trace(&wide, [-8.0, 1.0, 4.0], [2.0, 1.0, 0.0]);
    assert!(assert_hit(&near, "3", ["-2", "4", "4"], ["-0.6", "0", "0.8"]));
    let far = trace(&wide, [-1.0, 1.0, 4.0], [2.0, 1.0, 0.0]);
    assert!(assert_hit(&far, "2.5", ["4", "3.5", "4"], ["0.6", "0", "0.8"]));
    assert!(misses(&wide, [-8.0, 1.0, 6.0], [2.0, 1.0, 0.0], "beside"));
    assert!(misses(&wide, [7.0, 1.0, 4.0], [2.0, 1.0, 0.0], "behind, above or below"));
    // From inside out of the open top.
    assert!(misses(&wide, [-1.0, 8.0, 4.0], [2.0, 1.0, 0.0], "behind, above or below"));
    // A tangent touches it.
    let tangent = trace(&WALL, [1.0, 0.0, -5.0], [0.0, 0.0, 1.0]);
    assert!(!assert_hit(&tangent, "5", ["1", "0", "0"], ["1", "0", "0"]));
}

#[test]
fn the_far_wall_is_seen_through_an_open_end() {
    // Past the near wall at y = 1.5, down to the far one at y = -0.5.
    let through = trace(&WALL, [0.0, 3.5, -3.0], [0.0, -1.0, 1.0]);
    assert!(assert_hit(&through, "4", ["0", "-0.5", "1"], ["0", "0", "1"]));
    let from_below = trace(&WALL, [0.0, -3.5, -3.0], [0.0, 1.0, 1.0]);
    assert!(assert_hit(&from_below, "4", ["0", "0.5", "1"], ["0", "0", "1"]));
    // In at the top and out at the bottom.
    let steep = trace(&WALL, [0.0, 5.0, -2.0], [0.0, -3.0, 1.0]);
    assert!(assert_miss(&steep, "behind, above or below"));
}

#[test]
fn both_rims_belong_to_the_wall() {
    let top = trace(&WALL, [0.0, 3.0, -3.0], [0.0, -1.0, 1.0]);
    assert!(!assert_hit(&top, "2", ["0", "1", "-1"], ["0", "0", "-1"]));
    assert_eq!(top.margin, 0.0);
    let bottom = trace(&WALL, [0.0, -3.0, -3.0], [0.0, 1.0, 1.0]);
    assert!(!assert_hit(&bottom, "2", ["0", "-1", "-1"], ["0", "0", "-1"]));
    // Level with a rim no rounding can occur.
    let level = trace(&WALL, [0.0, 1.0, -3.0], [0.0, 0.0, 1.0]);
    assert!(assert_hit(&level, "2", ["0", "1", "-1"], ["0", "0", "-1"]));
    // An ulp above the rim, which f32 subtracts without rounding.
    let over = trace(&WALL, [0.0, 1.0 + f32::EPSILON, -3.0], [0.0, 0.0, 1.0]);
    assert!(assert_miss(&over, "behind, above or below"));
}

#[test]
fn a_ray_along_the_axis_misses_a_cylinder() {
    assert!(misses(&WALL, [0.0, -5.0, 0.0], [0.0, 1.0, 0.0], "parallel to the axis"));
    // In the wall itself.
    assert!(misses(&WALL, [1.0, -5.0, 0.0], [0.0, 1.0, 0.0], "parallel to the axis"));
}

#[test]
fn a_start_on_the_wall_hits_only_the_other_side() {
    let inward = trace(&WALL, [0.0, 0.0, -1.0], [0.0, 0.25, 1.0]);
    assert!(assert_hit(&inward, "2", ["0", "0.5", "1"], ["0", "0", "1"]));
    assert!(misses(&WALL, [0.0, 0.0, -1.0], [0.0, 0.25, -1.0], "behind, above or below"));
}

#[test]
fn a_cylinder_that_is_none_is_missed() {
    let cylinder = |bottom, top, radius| Primitive::Cylinder { bottom, top, radius };
    for (primitive, reason) in [
        (cylinder([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 0.0), "no radius or height"),
        (cylinder([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], -1.0), "no radius or height"),
        (cylinder([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], 1.0), "no radius or height"),
        (cylinder([0.0, -1.0, 0.0], [0.5, 1.0, 0.0], 1.0), "askew"),
    ] {
        assert!(misses(&primitive, [0.0, 0.0, -3.0], [0.0, 0.0, 1.0], reason));
    }
}

#[test]
fn the_nearest_triangle_of_a_mesh_counts() {
    let at = |z| [[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z]];
    let mesh = Primitive::Mesh { triangles: vec![at(3.0), at(1.0), at(2.0), at(f32::NAN)] };
    let hit = trace(&mesh, [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(hit.expect, Expect::MeshHit { t: "1".parse().expect("a number") });
    assert!(hit.decidable && hit.margin == 0.0, "a vertex, and yet no excuse");
    assert!(misses(&mesh, [3.0, 3.0, 0.0], [0.0, 0.0, 1.0], "no triangle"));
    assert!(misses(&mesh, [1.0, 1.0, 0.0], [0.0; 3], "zero direction"));
    // A miss is as certain as the nearest miss of all.
    let apart = [[9.0, 9.0, 1.0], [9.0, 8.0, 1.0], [8.0, 9.0, 1.0]];
    let mesh = Primitive::Mesh { triangles: vec![at(1.0), apart] };
    let beside = trace(&mesh, [2.0 + 2.0 * f32::EPSILON, 2.0, 0.0], [0.0, 0.0, 1.0]);
    assert!(!assert_miss(&beside, "no triangle"));
}

#[test]
fn input_that_is_not_finite_is_missed() {
    let ball = Primitive::Sphere { center: [0.0; 3], radius: 1.0 };
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(misses(&ball, [0.0, bad, -3.0], [0.0, 0.0, 1.0], "non-finite input"));
        assert!(misses(&ball, [0.0, 0.0, -3.0], [bad, 0.0, 1.0], "non-finite input"));
        let odd = Primitive::Sphere { center: [0.0; 3], radius: bad };
        assert!(misses(&odd, [0.0, 0.0, -3.0], [0.0, 0.0, 1.0], "non-finite input"));
    }
    assert!(misses(&ball, [0.0, 0.0, -3.0], [0.0, -0.0, 0.0], "zero direction"));
}

#[test]
fn the_extremes_of_f32_are_answered() {
    let (large, small) = (f32::MAX, f32::from_bits(1));
    let huge = Primitive::Sphere { center: [0.0; 3], radius: large };
    assert!(trace(&huge, [0.0; 3], [small, 0.0, 0.0]).expect.is_hit());
    let speck = Primitive::Sphere { center: [large, 0.0, 0.0], radius: small };
    assert!(trace(&speck, [-large, 0.0, 0.0], [small, 0.0, 0.0]).expect.is_hit());
    let sheet = Primitive::Triangle {
        a: [large, -large, large],
        b: [large, large, large],
        c: [large, 0.0, -large],
    };
    let answer = trace(&sheet, [-large, 0.0, 0.0], [small, 0.0, 0.0]);
    assert!(answer.expect.is_hit() && answer.cond.is_finite() && answer.margin.is_finite());
    let tube =
        Primitive::Cylinder { bottom: [0.0, -large, 0.0], top: [0.0, large, 0.0], radius: small };
    assert!(trace(&tube, [0.0, large, -large], [0.0, -large, large]).expect.is_hit());
}
