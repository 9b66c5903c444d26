//! What is true of every hit, whatever the scene: properties of the tracer's geometry.
//!
//! Coordinates are drawn as multiples of 1/256, which both precisions hold exactly. Then much of
//! what one would say "about" can be said of every bit: a scene moved, mirrored, or enlarged by a
//! power of two is hit in the same places. The draws are the same in every run.

use glam::DVec3;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_core::Caster;
use rayweave_core::cast::Hit;
use rayweave_core::scene::{Cylinder, Plane, Sphere, Triangle};
use rayweave_core::{Precision, Scene};
use rayweave_tests::model::{self, Primitive, Ray};
use rayweave_tests::scenes;
use rayweave_tests::transform::{enlarged, mirrored, moved, rounded};

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(2024),
        failure_persistence: None,
        // Many rays miss a single thing, and say nothing about a hit.
        max_global_rejects: 100_000,
        ..ProptestConfig::default()
    }
}

// What is drawn

fn coordinate() -> impl Strategy<Value = f64> {
    (-2048..=2048i32).prop_map(|k| f64::from(k) / 256.0)
}

fn point() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

fn direction() -> impl Strategy<Value = DVec3> {
    point().prop_filter("no direction", |v| *v != DVec3::ZERO)
}

/// From 1/256 to 4, small as often as large.
fn size() -> impl Strategy<Value = f64> {
    prop_oneof![1..=8i32, 8..=128, 128..=1024].prop_map(|k| f64::from(k) / 256.0)
}

fn plane() -> impl Strategy<Value = Plane> {
    (point(), direction()).prop_map(|(point, normal)| Plane { point, normal, material: 0 })
}

fn sphere() -> impl Strategy<Value = Sphere> {
    (point(), size()).prop_map(|(center, radius)| Sphere { center, radius, material: 0 })
}

fn triangle() -> impl Strategy<Value = Triangle> {
    [point(), point(), point()]
        .prop_map(|vertices| Triangle { vertices, material: 0 })
        .prop_filter("no area", |triangle| triangle.check().is_ok())
}

fn cylinder() -> impl Strategy<Value = Cylinder> {
    (point(), size(), size()).prop_map(|(bottom, height, radius)| Cylinder {
        bottom,
        top: bottom + height * DVec3::Y,
        radius,
        material: 0,
    })
}

/// One thing of any kind.
fn thing() -> impl Strategy<Value = Primitive> {
    prop_oneof![
        plane().prop_map(Primitive::Plane),
        sphere().prop_map(Primitive::Sphere),
        triangle().prop_map(Primitive::Triangle),
        cylinder().prop_map(Primitive::Cylinder),
    ]
}

fn things() -> impl Strategy<Value = Vec<Primitive>> {
    vec(thing(), 1..=8)
}

fn ray() -> impl Strategy<Value = Ray> {
    (point(), direction()).prop_map(|(origin, direction)| Ray { origin, direction })
}

/// From the same place, but towards a thing: `share` of its size beside its middle, or beyond the
/// corner of a triangle.
fn aimed(ray: &Ray, thing: &Primitive, share: DVec3) -> Ray {
    let target = match *thing {
        Primitive::Plane(plane) => plane.point + 8.0 * share,
        Primitive::Sphere(sphere) => sphere.center + sphere.radius * share,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            a + (b - a) * share.x.abs() + (c - a) * share.y.abs()
        }
        Primitive::Cylinder(cylinder) => {
            let (middle, height) =
                (cylinder.bottom.midpoint(cylinder.top), cylinder.top.y - cylinder.bottom.y);
            middle + DVec3::new(cylinder.radius, 0.5 * height, cylinder.radius) * share
        }
    };
    let direction = target - ray.origin;
    if direction == DVec3::ZERO { *ray } else { Ray { direction, ..*ray } }
}

/// Each component in -1..=1, so that some aims are beside a sphere and some hit it at its outline.
fn share() -> impl Strategy<Value = DVec3> {
    point().prop_map(|point| point / 8.0)
}

/// A scene of these things, in the order of the model.
fn scene_of(things: &[Primitive]) -> Scene {
    let mut scene = scenes::empty();
    for thing in things {
        match *thing {
            Primitive::Plane(plane) => scene.planes.push(plane),
            Primitive::Sphere(sphere) => scene.spheres.push(sphere),
            Primitive::Triangle(triangle) => scene.triangles.push(triangle),
            Primitive::Cylinder(cylinder) => scene.cylinders.push(cylinder),
        }
    }
    scene
}

/// The things of a scene by their numbers.
fn things_of(scene: &Scene) -> Vec<Primitive> {
    let planes = scene.planes.iter().copied().map(Primitive::Plane);
    let spheres = scene.spheres.iter().copied().map(Primitive::Sphere);
    let triangles = scene.triangles.iter().copied().map(Primitive::Triangle);
    let cylinders = scene.cylinders.iter().copied().map(Primitive::Cylinder);
    planes.chain(spheres).chain(triangles).chain(cylinders).collect()
}

fn hit(scene: &Scene, ray: &Ray, precision: Precision) -> Option<Hit> {
    Caster::new(&scene.with_arithmetic(precision))
        .expect("a sound scene")
        .closest_hit(ray.origin, ray.direction)
}

fn hit_alone(thing: Primitive, ray: &Ray, precision: Precision) -> Option<Hit> {
    hit(&scene_of(&[thing]), ray, precision)
}

// How far off rounding may be

fn roundoff(precision: Precision) -> f64 {
    match precision {
        Precision::F32 => f64::from(f32::EPSILON) / 2.0,
        Precision::F64 => f64::EPSILON / 2.0,
    }
}

/// The size of the numbers that a thing's distance from a point is made of, along its normal there.
fn reach(thing: &Primitive, point: DVec3) -> f64 {
    let own = match thing {
        Primitive::Plane(plane) => plane.point.abs(),
        Primitive::Sphere(sphere) => sphere.center.abs() + sphere.radius,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            a.abs().max(b.abs()).max(c.abs())
        }
        Primitive::Cylinder(cylinder) => cylinder.bottom.abs() + cylinder.radius,
    };
    thing.normal(point).abs().dot(point.abs() + own)
}

/// The distance of a point from a thing's surface, which goes on beyond edges and rims.
fn off_surface(thing: &Primitive, point: DVec3) -> f64 {
    let flat = |through: DVec3| (point - through).dot(thing.normal(point)).abs();
    match thing {
        Primitive::Plane(plane) => flat(plane.point),
        Primitive::Sphere(sphere) => (point.distance(sphere.center) - sphere.radius).abs(),
        Primitive::Triangle(triangle) => flat(triangle.vertices[0]),
        Primitive::Cylinder(cylinder) => {
            let axis = DVec3 { y: point.y, ..cylinder.bottom };
            (point.distance(axis) - cylinder.radius).abs()
        }
    }
}

/// How far beyond a triangle's edges or a cylinder's rims a point of the surface is.
fn beyond_edge(thing: &Primitive, point: DVec3) -> f64 {
    match thing {
        Primitive::Plane(_) | Primitive::Sphere(_) => 0.0,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            let normal = thing.normal(point);
            let outside =
                |from: DVec3, to: DVec3| (point - from).dot((to - from).cross(normal).normalize());
            outside(*a, *b).max(outside(*b, *c)).max(outside(*c, *a)).max(0.0)
        }
        Primitive::Cylinder(Cylinder { bottom, top, .. }) => {
            (bottom.y - point.y).max(point.y - top.y).max(0.0)
        }
    }
}

// Hits

proptest! {
    #![proptest_config(config())]

    /// Catches a wrong root, a formula that cancels, and an error bound that is too small: what
    /// mirrors and shadows start from is as near to the surface as the tracer counts on, 12 units
    /// of roundoff of the numbers in it. Twice that for `f64`, in which this test itself rounds.
    #[test]
    fn a_hit_lies_on_its_surface(
        thing in thing(),
        ray in ray(),
        share in share(),
        far in prop_oneof![Just(1.0), 10.0..300.0f64],
        scale in 0.001..1000.0f64,
        offset in prop_oneof![Just(DVec3::ZERO), point().prop_map(|offset| 100.0 * offset)],
    ) {
        let ray = aimed(&Ray { origin: far * ray.origin, ..ray }, &thing, share);
        // Any numbers, but those that `f32` has: else the surface itself would be another.
        let scene = rounded(&moved(&enlarged(&scene_of(&[thing]), scale), offset * scale));
        let thing = things_of(&scene)[0];
        let narrow = |v: DVec3| v.map(|x| f64::from(x as f32));
        let ray = Ray { origin: narrow((ray.origin + offset) * scale), ..ray };
        // Rounding took the area of a triangle.
        prop_assume!(scene.check().is_ok());
        for precision in PRECISIONS {
            let hit = hit(&scene, &ray, precision);
            prop_assume!(hit.is_some());
            let hit = hit.expect("checked");
            let u = roundoff(precision) * if precision == Precision::F64 { 2.0 } else { 1.0 };
            prop_assert!(hit.t > 0.0 && hit.t.is_finite());
            let off = off_surface(&thing, hit.point);
            prop_assert!(off <= 12.0 * u * reach(&thing, hit.point), "{precision}: {off:e} off, {hit:?}");

            // Before it was moved onto the surface, the ray's length comes in.
            let there = ray.at(hit.t);
            let distance = ray.origin.distance(there);
            let size = reach(&thing, hit.point) + reach(&thing, ray.origin) + distance;
            let off = off_surface(&thing, there);
            prop_assert!(off <= 12.0 * u * size, "{precision}: t is {off:e} off, {hit:?}");

            // Along the surface an error is the larger the lower the ray comes in.
            let normal = thing.normal(hit.point);
            let cosine = normal.dot(ray.direction.normalize()).abs();
            let beyond = beyond_edge(&thing, hit.point);
            let size = size + hit.point.length() + ray.origin.length();
            prop_assert!(beyond * cosine <= 12.0 * u * size, "{precision}: {beyond:e} beyond, {hit:?}");

            prop_assert!((hit.normal.length() - 1.0).abs() <= 4.0 * u);
            prop_assert!(hit.normal.dot(ray.direction) <= 4.0 * u * ray.direction.length(), "{hit:?}");
            let turned = hit.normal * hit.normal.dot(normal).signum();
            let error = 12.0 * u * reach(&thing, hit.point) / radius(&thing).unwrap_or(f64::INFINITY);
            prop_assert!(turned.distance(normal) <= error + 8.0 * u, "{precision}: {hit:?}");
        }
    }

    /// Catches a kind or an entry that is left out, a wrong number, and a wrong order between equal
    /// distances: the nearest hit is, to the bit, the first of the smallest `t` of all things
    /// alone.
    #[test]
    fn nothing_alone_is_nearer(
        things in things(),
        copied: prop::sample::Index,
        ray in ray(),
        share in share(),
    ) {
        let mut things = things;
        let copied = *copied.get(&things);
        things.push(copied);
        let ray = aimed(&ray, &copied, share);
        let scene = scene_of(&things);
        for precision in PRECISIONS {
            let alone = things_of(&scene).into_iter().map(|thing| hit_alone(thing, &ray, precision));
            let hits = alone.enumerate().filter_map(|(number, hit)| Some(Hit { primitive: number, ..hit? }));
            // Of equal ones `min_by` takes the first.
            let first = hits.min_by(|a, b| a.t.total_cmp(&b.t));
            prop_assert_eq!(hit(&scene, &ray, precision), first);
        }
    }

    /// Catches a hit that depends on what was looked at before it: a bound that is not reset, a
    /// thing that is skipped after a hit.
    #[test]
    fn order_decides_between_equal_distances_only(things in things(), ray in ray(), share in share()) {
        let ray = aimed(&ray, &things[0], share);
        let scene = scene_of(&things);
        let reversed: Vec<_> = things.iter().copied().rev().collect();
        let reversed = scene_of(&reversed);
        for precision in PRECISIONS {
            let (found, again) = (hit(&scene, &ray, precision), hit(&reversed, &ray, precision));
            prop_assert_eq!(found.map(|hit| hit.t), again.map(|hit| hit.t));
            let (Some(found), Some(again)) = (found, again) else { continue };
            let (one, other) =
                (things_of(&scene)[found.primitive], things_of(&reversed)[again.primitive]);
            let t = |thing| hit_alone(thing, &ray, precision).map(|hit| hit.t);
            prop_assert!(one == other || t(one) == t(other), "{one:?} or {other:?}");
        }
    }

    /// Catches a tie that goes to the later one: a copy after a thing changes nothing, a copy at
    /// the head of its kind takes the hit.
    #[test]
    fn equal_distances_go_to_the_first(things in things(), ray in ray(), share in share()) {
        let ray = aimed(&ray, &things[0], share);
        let scene = scene_of(&things);
        for precision in PRECISIONS {
            let found = hit(&scene, &ray, precision);
            prop_assume!(found.is_some());
            let found = found.expect("checked");
            let nearest = things_of(&scene)[found.primitive];
            let after: Vec<_> = things.iter().copied().chain([nearest]).collect();
            prop_assert_eq!(hit(&scene_of(&after), &ray, precision), Some(found));
            let before: Vec<_> = [nearest].into_iter().chain(things.iter().copied()).collect();
            let before = scene_of(&before);
            let again = hit(&before, &ray, precision).expect("still there");
            let kind = std::mem::discriminant(&nearest);
            let head = things_of(&before).iter().position(|thing| std::mem::discriminant(thing) == kind);
            prop_assert_eq!(again, Hit { primitive: head.expect("its copy"), ..found });
        }
    }

    /// Catches a constant that should follow the scene's scale: an epsilon, a tolerance, a limit.
    /// Powers of two round nothing, so that not a bit may change.
    #[test]
    fn a_scene_enlarged_by_a_power_of_two_is_hit_in_the_same_places(
        things in things(),
        ray in ray(),
        share in share(),
        scale in -18..=18i32,
        stretch in -12..=12i32,
    ) {
        let ray = aimed(&ray, &things[0], share);
        let (scale, stretch) = (2f64.powi(scale), 2f64.powi(stretch));
        let scene = scene_of(&things);
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
    fn a_mirrored_scene_is_hit_in_the_mirrored_places(things in things(), ray in ray(), share in share()) {
        let ray = aimed(&ray, &things[0], share);
        let scene = scene_of(&things);
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
        things in things(),
        ray in ray(),
        share in share(),
        offset in [-4096..=4096i32, -4096..=4096, -4096..=4096],
    ) {
        let ray = aimed(&ray, &things[0], share);
        let offset = DVec3::from_array(offset.map(f64::from));
        let scene = scene_of(&things);
        let moved = moved(&scene, offset);
        let moved_ray = Ray { origin: ray.origin + offset, ..ray };
        for precision in PRECISIONS {
            let u = roundoff(precision);
            let size = offset.abs().max_element() + ray.origin.abs().max_element() + 8.0;
            // A rim's height is compared with the coordinate itself: beside it, either is right.
            prop_assume!(!scene.cylinders.iter().any(|cylinder| at_rim(cylinder, &ray, 8.0 * u * size)));
            let (found, expected) = (hit(&moved, &moved_ray, precision), hit(&scene, &ray, precision));
            prop_assert_eq!(found.map(|hit| (hit.t, hit.primitive)), expected.map(|hit| (hit.t, hit.primitive)));
            let (Some(found), Some(expected)) = (found, expected) else { continue };
            let size = size + found.point.abs().max_element();
            let off = found.point.distance(expected.point + offset);
            prop_assert!(off <= 8.0 * u * size, "{precision}: {off:e} off");
            let radius = radius(&things_of(&scene)[expected.primitive]).unwrap_or(f64::INFINITY);
            let turn = found.normal.distance(expected.normal);
            prop_assert!(turn <= 8.0 * u * size / radius, "{precision}: {turn:e}");
        }
    }

    /// Catches a surface with one side, and a normal that follows the order of the corners instead
    /// of the ray.
    #[test]
    fn a_flat_thing_has_two_sides(
        thing in prop_oneof![
            plane().prop_map(Primitive::Plane),
            triangle().prop_map(Primitive::Triangle),
        ],
        ray in ray(),
        share in share(),
    ) {
        let ray = aimed(&ray, &thing, share);
        let turned = match thing {
            Primitive::Plane(plane) => Primitive::Plane(Plane { normal: -plane.normal, ..plane }),
            Primitive::Triangle(Triangle { vertices: [a, b, c], material }) =>
                Primitive::Triangle(Triangle { vertices: [a, c, b], material }),
            other => other,
        };
        for precision in PRECISIONS {
            let found = hit_alone(thing, &ray, precision);
            prop_assert_eq!(found, hit_alone(turned, &ray, precision));
            prop_assume!(found.is_some());
            let found = found.expect("checked");
            // From the other side, and from as far behind it.
            let length = ray.direction.length() * found.t;
            let beyond = Ray { origin: found.point + ray.direction * found.t, direction: -ray.direction };
            prop_assume!(clearly_inside(&thing, found.point, roundoff(precision), &ray));
            let back = hit_alone(thing, &beyond, precision);
            prop_assert!(back.is_some(), "{precision}: {found:?}");
            let back = back.expect("checked");
            prop_assert_eq!(back.normal, -found.normal);
            let cosine = found.normal.dot(ray.direction.normalize()).abs();
            let size = ray.origin.length() + found.point.length() + length + reach(&thing, found.point);
            let error = 16.0 * roundoff(precision) * size / cosine;
            prop_assert!(back.point.distance(found.point) <= error, "{precision}: {back:?}");
        }
    }

    /// Catches a sphere or tube that is only seen from outside: from within the one hit is the far
    /// root, and its normal is turned inwards.
    #[test]
    fn a_round_thing_is_hit_from_inside(
        sphere in sphere(),
        out in direction(),
        share in 0.0..0.99f64,
        direction in direction(),
    ) {
        let narrow = |v: DVec3| v.map(|x| f64::from(x as f32));
        let origin = narrow(sphere.center + share * sphere.radius * out.normalize());
        let ray = Ray { origin, direction };
        let Sphere { center, radius, material } = sphere;
        // So high that no ray leaves through an end, unless it goes along the axis.
        let across = DVec3 { y: 0.0, ..direction };
        let height = 256.0 * DVec3::Y;
        let tube = Cylinder { bottom: center - height, top: center + height, radius, material };
        let leaves = across.length() * 30.0 < direction.length();
        let mut things = vec![Primitive::Sphere(sphere)];
        things.extend((!leaves).then_some(Primitive::Cylinder(tube)));
        for (thing, precision) in things.into_iter().flat_map(|thing| PRECISIONS.map(|p| (thing, p))) {
            let found = hit_alone(thing, &ray, precision);
            prop_assert!(found.is_some(), "{precision}: out of {thing:?}");
            let found = found.expect("checked");
            prop_assert!(found.normal.dot(thing.normal(found.point)) < -0.99, "{precision}: {found:?}");
            prop_assert!(found.normal.dot(direction) < 0.0);
        }
    }

    /// Catches a `t` that is taken for a distance, and a formula for unit directions alone: a
    /// direction of another length meets the same point at another `t`.
    #[test]
    fn the_length_of_a_direction_does_not_matter(
        thing in thing(),
        ray in ray(),
        share in share(),
        factor in 0.001..1000.0f64,
    ) {
        let ray = aimed(&ray, &thing, share);
        let stretched = Ray { direction: factor * ray.direction, ..ray };
        for precision in PRECISIONS {
            let u = roundoff(precision);
            let found = hit_alone(thing, &ray, precision);
            prop_assume!(found.is_some());
            let found = found.expect("checked");
            let cosine = found.normal.dot(ray.direction.normalize()).abs();
            // The stretched direction is rounded, and so another one: beside an edge it may miss.
            prop_assume!(cosine > 0.05 && clearly_inside(&thing, found.point, u, &ray));
            let again = hit_alone(thing, &stretched, precision);
            prop_assert!(again.is_some(), "{precision}: {found:?}");
            let again = again.expect("checked");
            let size = ray.origin.length() + found.point.length() + reach(&thing, found.point);
            let error = 16.0 * u * size / cosine;
            prop_assert!(again.point.distance(found.point) <= error, "{precision}: {again:?}, {found:?}");
            let distances = [again.t * stretched.direction.length(), found.t * ray.direction.length()];
            prop_assert!((distances[0] - distances[1]).abs() <= error, "{precision}: {distances:?}");
        }
    }
}

fn radius(thing: &Primitive) -> Option<f64> {
    match thing {
        Primitive::Plane(_) | Primitive::Triangle(_) => None,
        Primitive::Sphere(sphere) => Some(sphere.radius),
        Primitive::Cylinder(cylinder) => Some(cylinder.radius),
    }
}

/// Whether the ray meets a tube's wall nearer than `margin` to a rim.
fn at_rim(cylinder: &Cylinder, ray: &Ray, margin: f64) -> bool {
    let height = 1e6 * DVec3::Y;
    let endless =
        Cylinder { bottom: cylinder.bottom - height, top: cylinder.top + height, ..*cylinder };
    let rims = [cylinder.bottom.y, cylinder.top.y];
    let near = |t: f64| {
        rims.iter().any(|rim| (ray.at(t).y - rim).abs() < margin * (1.0 + ray.at(t).length()))
    };
    model::cylinder_roots(&endless, ray).into_iter().flatten().any(near)
}

/// Whether a hit is so far from every edge and rim that another rounding also hits.
fn clearly_inside(thing: &Primitive, point: DVec3, u: f64, ray: &Ray) -> bool {
    let cosine = thing.normal(point).dot(ray.direction.normalize()).abs();
    let margin =
        32.0 * u * (ray.origin.length() + 2.0 * point.length() + reach(thing, point)) / cosine;
    match thing {
        Primitive::Plane(_) | Primitive::Sphere(_) => true,
        Primitive::Triangle(Triangle { vertices: [a, b, c], .. }) => {
            let normal = thing.normal(point);
            let inside =
                |from: DVec3, to: DVec3| (from - point).dot((to - from).cross(normal).normalize());
            inside(*a, *b).min(inside(*b, *c)).min(inside(*c, *a)) > margin
        }
        Primitive::Cylinder(Cylinder { bottom, top, .. }) => {
            (point.y - bottom.y).min(top.y - point.y) > margin
        }
    }
}
