//! Properties of every hit, whatever the scene.
//!
//! Coordinates are drawn as multiples of 1/256, which both precisions hold exactly. Many properties
//! then hold for every bit: a scene moved, mirrored, or enlarged by a power of two is hit in the
//! same places. The draws are the same in every run.

use crate::arbitrary::{
    aimed, aimed_at, direction, plane, point, primitive, ray, several, share, size, triangle,
};
use glam::DVec3;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_core::cast::Hit;
use rayweave_core::scene::{Cylinder, Plane, Triangle};
use rayweave_core::{Precision, Scene};
use rayweave_tests::model::{Model, Primitive, Ray};
use rayweave_tests::scenes::{self, PRECISIONS, caster, of};
use rayweave_tests::transform::{enlarged, mirrored, moved, rounded};

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(2024),
        failure_persistence: None,
        // Many rays miss a single primitive, and say nothing about a hit.
        max_global_rejects: 100_000,
        ..ProptestConfig::default()
    }
}

/// The primitives of a scene by their numbers.
fn primitives_of(scene: &Scene) -> Vec<Primitive> {
    Model::new(scene).primitives
}

fn hit(scene: &Scene, ray: &Ray, precision: Precision) -> Option<Hit> {
    caster(scene, precision).closest_hit(ray.origin, ray.direction)
}

fn hit_alone(primitive: Primitive, ray: &Ray, precision: Precision) -> Option<Hit> {
    hit(&of([primitive]), ray, precision)
}

/// The same vector as `f32` holds it.
fn narrow(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

// Bounds of rounding errors

fn roundoff(precision: Precision) -> f64 {
    match precision {
        Precision::F32 => f64::from(f32::EPSILON) / 2.0,
        Precision::F64 => f64::EPSILON / 2.0,
    }
}

/// The size of the numbers that give the distance of a primitive from a point, along its normal
/// there.
fn reach(primitive: &Primitive, point: DVec3) -> f64 {
    let own = match primitive {
        Primitive::Plane(plane) => plane.point.abs(),
        Primitive::Sphere(sphere) => sphere.center.abs() + sphere.radius,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            a.abs().max(b.abs()).max(c.abs())
        }
        Primitive::Cylinder(cylinder) => cylinder.bottom.abs() + cylinder.radius,
    };
    primitive.normal(point).abs().dot(point.abs() + own)
}

/// The distance of a point from the surface of a primitive, continued beyond edges and rims.
pub(crate) fn off_surface(primitive: &Primitive, point: DVec3) -> f64 {
    let flat = |through: DVec3| (point - through).dot(primitive.normal(point)).abs();
    match primitive {
        Primitive::Plane(plane) => flat(plane.point),
        Primitive::Sphere(sphere) => (point.distance(sphere.center) - sphere.radius).abs(),
        Primitive::Triangle(triangle) => flat(triangle.vertices[0]),
        Primitive::Cylinder(cylinder) => {
            let axis = DVec3 { y: point.y, ..cylinder.bottom };
            (point.distance(axis) - cylinder.radius).abs()
        }
    }
}

/// The distance by which a point of the surface is beyond the nearest edge of a triangle or rim of
/// a cylinder; negative within it.
pub(crate) fn beyond_edge(primitive: &Primitive, point: DVec3) -> f64 {
    match *primitive {
        Primitive::Plane(_) | Primitive::Sphere(_) => f64::NEG_INFINITY,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            let normal = primitive.normal(point);
            let outside =
                |from: DVec3, to: DVec3| (point - from).dot((to - from).cross(normal).normalize());
            outside(a, b).max(outside(b, c)).max(outside(c, a))
        }
        Primitive::Cylinder(Cylinder { bottom, top, .. }) => {
            (bottom.y - point.y).max(point.y - top.y)
        }
    }
}

/// The radius of a round primitive; infinite for a flat one.
fn radius(primitive: &Primitive) -> f64 {
    match primitive {
        Primitive::Plane(_) | Primitive::Triangle(_) => f64::INFINITY,
        Primitive::Sphere(sphere) => sphere.radius,
        Primitive::Cylinder(cylinder) => cylinder.radius,
    }
}

/// Returns true if the ray meets a tube's wall nearer than `margin` to a rim.
fn at_rim(cylinder: &Cylinder, ray: &Ray, margin: f64) -> bool {
    let height = 1e6 * DVec3::Y;
    let endless =
        Cylinder { bottom: cylinder.bottom - height, top: cylinder.top + height, ..*cylinder };
    let near = |t: f64| {
        [cylinder.bottom.y, cylinder.top.y]
            .iter()
            .any(|rim| (ray.at(t).y - rim).abs() < margin * (1.0 + ray.at(t).length()))
    };
    Primitive::Cylinder(endless).roots(ray).into_iter().flatten().any(near)
}

/// Returns true for a hit so far from every edge and rim that another rounding also hits.
fn clearly_inside(primitive: &Primitive, point: DVec3, u: f64, ray: &Ray) -> bool {
    let cosine = primitive.normal(point).dot(ray.direction.normalize()).abs();
    let size = ray.origin.length() + 2.0 * point.length() + reach(primitive, point);
    beyond_edge(primitive, point) < -32.0 * u * size / cosine
}

// Hits

proptest! {
    #![proptest_config(config())]

    /// Catches a wrong root, a formula that cancels, and an error bound that is too small. Mirrors
    /// and shadows start as near to the surface as the tracer counts on, 12 units of roundoff of
    /// the numbers in it. The bound is twice that for `f64`, in which this test itself rounds.
    #[test]
    fn a_hit_lies_on_its_surface(
        primitive in primitive(),
        ray in ray(),
        share in share(),
        far in prop_oneof![Just(1.0), 10.0..300.0f64],
        scale in 0.001..1000.0f64,
        offset in prop_oneof![Just(DVec3::ZERO), point().prop_map(|offset| 100.0 * offset)],
    ) {
        let ray = aimed(&Ray { origin: far * ray.origin, ..ray }, &primitive, share);
        // Any numbers that `f32` holds: else the surface itself would be another.
        let scene = rounded(&moved(&enlarged(&of([primitive]), scale), offset * scale));
        let primitive = primitives_of(&scene)[0];
        let ray = Ray { origin: narrow((ray.origin + offset) * scale), ..ray };
        // Rounding may take the area of a triangle.
        prop_assume!(scene.check().is_ok());
        for precision in PRECISIONS {
            let hit = hit(&scene, &ray, precision);
            prop_assume!(hit.is_some());
            let hit = hit.expect("checked");
            let u = roundoff(precision) * if precision == Precision::F64 { 2.0 } else { 1.0 };
            let context = format!("{precision}: {hit:?}");
            prop_assert!(hit.t > 0.0 && hit.t.is_finite());
            let near = reach(&primitive, hit.point);
            let off = off_surface(&primitive, hit.point);
            prop_assert!(off <= 12.0 * u * near, "{context} is {off:e} off");

            // Before it was moved onto the surface, the ray's length counts.
            let there = ray.at(hit.t);
            let size = near + reach(&primitive, ray.origin) + ray.origin.distance(there);
            let off = off_surface(&primitive, there);
            prop_assert!(off <= 12.0 * u * size, "{context}, t is {off:e} off");

            // The flatter the ray, the larger an error along the surface.
            let normal = primitive.normal(hit.point);
            let cosine = normal.dot(ray.direction.normalize()).abs();
            let beyond = beyond_edge(&primitive, hit.point).max(0.0);
            let size = size + hit.point.length() + ray.origin.length();
            prop_assert!(beyond * cosine <= 12.0 * u * size, "{context} is {beyond:e} beyond");

            prop_assert!((hit.normal.length() - 1.0).abs() <= 4.0 * u);
            let against = hit.normal.dot(ray.direction);
            prop_assert!(against <= 4.0 * u * ray.direction.length(), "{context}");
            let turned = hit.normal * hit.normal.dot(normal).signum();
            let error = 12.0 * u * near / radius(&primitive);
            prop_assert!(turned.distance(normal) <= error + 8.0 * u, "{context}");
        }
    }

    /// Catches a kind or an entry that is left out, a wrong number, and a wrong order between equal
    /// distances: the closest hit is, to the bit, the first of the smallest `t` of all primitives
    /// alone.
    #[test]
    fn no_primitive_alone_is_closer(
        mut primitives in vec(primitive(), 1..=8),
        copied: prop::sample::Index,
        ray in ray(),
        share in share(),
    ) {
        let copied = *copied.get(&primitives);
        primitives.push(copied);
        let ray = aimed(&ray, &copied, share);
        let scene = of(primitives);
        for precision in PRECISIONS {
            let numbered = primitives_of(&scene).into_iter().enumerate();
            let hits = numbered.filter_map(|(number, alone)| {
                Some(Hit { primitive: number, ..hit_alone(alone, &ray, precision)? })
            });
            // Of equal ones `min_by` takes the first.
            let first = hits.min_by(|a, b| a.t.total_cmp(&b.t));
            prop_assert_eq!(hit(&scene, &ray, precision), first);
        }
    }

    /// Catches a hit that depends on the primitives tried before it: a bound that is not reset, a
    /// primitive that is skipped after a hit.
    #[test]
    fn order_decides_between_equal_distances_only((primitives, ray) in several()) {
        let reversed = of(primitives.iter().copied().rev());
        let scene = of(primitives);
        for precision in PRECISIONS {
            let (found, again) = (hit(&scene, &ray, precision), hit(&reversed, &ray, precision));
            prop_assert_eq!(found.map(|hit| hit.t), again.map(|hit| hit.t));
            let (Some(found), Some(again)) = (found, again) else { continue };
            let one = primitives_of(&scene)[found.primitive];
            let other = primitives_of(&reversed)[again.primitive];
            let t = |primitive| hit_alone(primitive, &ray, precision).map(|hit| hit.t);
            prop_assert!(one == other || t(one) == t(other), "{one:?} or {other:?}");
        }
    }

    /// Catches a tie that goes to the later primitive: a copy after a primitive changes nothing, a
    /// copy at the head of its kind takes the hit.
    #[test]
    fn equal_distances_go_to_the_first((primitives, ray) in several()) {
        let scene = of(primitives.iter().copied());
        for precision in PRECISIONS {
            let found = hit(&scene, &ray, precision);
            prop_assume!(found.is_some());
            let found = found.expect("checked");
            let closest = primitives_of(&scene)[found.primitive];
            let after = of(primitives.iter().copied().chain([closest]));
            prop_assert_eq!(hit(&after, &ray, precision), Some(found));
            let before = of([closest].into_iter().chain(primitives.iter().copied()));
            let again = hit(&before, &ray, precision).expect("still there");
            let kind = std::mem::discriminant(&closest);
            let head =
                primitives_of(&before).iter().position(|p| std::mem::discriminant(p) == kind);
            prop_assert_eq!(again, Hit { primitive: head.expect("its copy"), ..found });
        }
    }

    /// Catches a constant that should follow the scene's scale: an epsilon, a tolerance, a limit.
    /// Powers of two round nothing, so that not a bit may change.
    #[test]
    fn a_scene_enlarged_by_a_power_of_two_is_hit_in_the_same_places(
        (primitives, ray) in several(),
        scale in -18..=18i32,
        stretch in -12..=12i32,
    ) {
        let (scale, stretch) = (2f64.powi(scale), 2f64.powi(stretch));
        let scene = of(primitives);
        let large = enlarged(&scene, scale);
        let long = Ray { origin: ray.origin * scale, direction: ray.direction * stretch };
        for precision in PRECISIONS {
            let expected = hit(&scene, &ray, precision)
                .map(|hit| Hit { t: hit.t * scale / stretch, point: hit.point * scale, ..hit });
            prop_assert_eq!(hit(&large, &long, precision), expected);
        }
    }

    /// Catches an axis that is mixed up with another or has its sign wrong: in the mirror every
    /// number has the same digits.
    #[test]
    fn a_mirrored_scene_is_hit_in_the_mirrored_places((primitives, ray) in several()) {
        let scene = of(primitives);
        let mirrors = [
            (mirrored::<0>(&scene), DVec3::new(-1.0, 1.0, 1.0)),
            (mirrored::<1>(&scene), DVec3::new(1.0, -1.0, 1.0)),
            (mirrored::<2>(&scene), DVec3::new(1.0, 1.0, -1.0)),
        ];
        for (mirrored, sign) in mirrors {
            let mirrored_ray = Ray { origin: ray.origin * sign, direction: ray.direction * sign };
            for precision in PRECISIONS {
                let expected = hit(&scene, &ray, precision)
                    .map(|hit| Hit { point: hit.point * sign, normal: hit.normal * sign, ..hit });
                prop_assert_eq!(hit(&mirrored, &mirrored_ray, precision), expected);
            }
        }
    }

    /// Catches a formula in coordinates instead of their differences, which loses digits far from
    /// the origin: `t` and the normals stay the same to the bit, and the point to its own roundoff.
    #[test]
    fn a_moved_scene_is_hit_in_the_moved_places(
        (primitives, ray) in several(),
        offset in [-4096..=4096i32, -4096..=4096, -4096..=4096],
    ) {
        let offset = DVec3::from_array(offset.map(f64::from));
        let scene = of(primitives);
        let moved = moved(&scene, offset);
        let moved_ray = Ray { origin: ray.origin + offset, ..ray };
        for precision in PRECISIONS {
            let u = roundoff(precision);
            let size = offset.abs().max_element() + ray.origin.abs().max_element() + 8.0;
            // A rim's height is compared with the coordinate itself: beside it, either is right.
            prop_assume!(!scene.cylinders.iter().any(|c| at_rim(c, &ray, 8.0 * u * size)));
            let found = hit(&moved, &moved_ray, precision);
            let expected = hit(&scene, &ray, precision);
            let same = |hit: Option<Hit>| hit.map(|hit| (hit.t, hit.primitive));
            prop_assert_eq!(same(found), same(expected));
            let (Some(found), Some(expected)) = (found, expected) else { continue };
            let size = size + found.point.abs().max_element();
            let off = found.point.distance(expected.point + offset);
            prop_assert!(off <= 8.0 * u * size, "{precision}: {off:e} off");
            let radius = radius(&primitives_of(&scene)[expected.primitive]);
            let turn = found.normal.distance(expected.normal);
            prop_assert!(turn <= 8.0 * u * size / radius, "{precision}: {turn:e}");
        }
    }

    /// Catches a surface with one side, and a normal that follows the order of the corners instead
    /// of the ray.
    #[test]
    fn a_flat_primitive_has_two_sides(
        (flat, ray) in aimed_at(prop_oneof![plane(), triangle()]),
    ) {
        let turned = match flat {
            Primitive::Plane(plane) => Primitive::Plane(Plane { normal: -plane.normal, ..plane }),
            Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
                scenes::triangle([a, c, b])
            }
            other => other,
        };
        for precision in PRECISIONS {
            let found = hit_alone(flat, &ray, precision);
            prop_assert_eq!(found, hit_alone(turned, &ray, precision));
            prop_assume!(found.is_some());
            let found = found.expect("checked");
            // From the other side, and from as far behind it.
            let way = ray.direction * found.t;
            let beyond = Ray { origin: found.point + way, direction: -ray.direction };
            prop_assume!(clearly_inside(&flat, found.point, roundoff(precision), &ray));
            let back = hit_alone(flat, &beyond, precision);
            prop_assert!(back.is_some(), "{precision}: {found:?}");
            let back = back.expect("checked");
            prop_assert_eq!(back.normal, -found.normal);
            let cosine = found.normal.dot(ray.direction.normalize()).abs();
            let size = ray.origin.length() + found.point.length() + way.length();
            let size = size + reach(&flat, found.point);
            let error = 16.0 * roundoff(precision) * size / cosine;
            prop_assert!(back.point.distance(found.point) <= error, "{precision}: {back:?}");
        }
    }

    /// Catches a sphere or tube that is only visible from outside: from within the one hit is the
    /// far root, and its normal is turned inwards.
    #[test]
    fn a_round_primitive_is_hit_from_inside(
        center in point(),
        radius in size(),
        out in direction(),
        share in 0.0..0.99f64,
        direction in direction(),
    ) {
        let ray = Ray { origin: narrow(center + share * radius * out.normalize()), direction };
        // So high that no ray leaves through an end, unless it goes along the axis.
        let tube = scenes::cylinder(center - 256.0 * DVec3::Y, 512.0, radius);
        let leaves = DVec3 { y: 0.0, ..direction }.length() * 30.0 < direction.length();
        let mut round = vec![scenes::sphere(center, radius)];
        round.extend((!leaves).then_some(tube));
        for (round, precision) in round.into_iter().flat_map(|one| PRECISIONS.map(|p| (one, p))) {
            let found = hit_alone(round, &ray, precision);
            prop_assert!(found.is_some(), "{precision}: out of {round:?}");
            let found = found.expect("checked");
            let inwards = -found.normal.dot(round.normal(found.point));
            prop_assert!(inwards > 0.99, "{precision}: {found:?}");
            prop_assert!(found.normal.dot(direction) < 0.0);
        }
    }

    /// Catches a `t` that is taken for a distance, and a formula for unit directions alone: a
    /// direction of another length meets the same point at another `t`.
    #[test]
    fn the_length_of_a_direction_does_not_matter(
        (primitive, ray) in aimed_at(primitive()),
        factor in 0.001..1000.0f64,
    ) {
        let stretched = Ray { direction: factor * ray.direction, ..ray };
        for precision in PRECISIONS {
            let u = roundoff(precision);
            let found = hit_alone(primitive, &ray, precision);
            prop_assume!(found.is_some());
            let found = found.expect("checked");
            let cosine = found.normal.dot(ray.direction.normalize()).abs();
            // The stretched direction is rounded, and so another one: beside an edge it may miss.
            prop_assume!(cosine > 0.05 && clearly_inside(&primitive, found.point, u, &ray));
            let again = hit_alone(primitive, &stretched, precision);
            prop_assert!(again.is_some(), "{precision}: {found:?}");
            let again = again.expect("checked");
            let size = ray.origin.length() + found.point.length();
            let error = 16.0 * u * (size + reach(&primitive, found.point)) / cosine;
            let off = again.point.distance(found.point);
            prop_assert!(off <= error, "{precision}: {again:?}, {found:?}");
            let distances =
                [again.t * stretched.direction.length(), found.t * ray.direction.length()];
            let off = (distances[0] - distances[1]).abs();
            prop_assert!(off <= error, "{precision}: {distances:?}");
        }
    }
}
