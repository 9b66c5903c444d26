//! The slips of the report: on the model that the tracer is compared with, and on the tracer.

use glam::DVec3;
use rayweave_core::Precision;
use rayweave_tests::errata::{RAYS, shadings};
use rayweave_tests::image;
use rayweave_tests::model::{render, samples};
use rayweave_tests::scenes::{PRECISIONS, caster, of};
use std::collections::HashSet;

// The model

#[test]
fn rays_hit_where_they_should() {
    for case in RAYS {
        let what = format!("{}: {}", case.name, case.report);
        let found = case.primitive.hit(&case.ray);
        let (Some(t), Some(expected)) = (found, case.expected) else {
            assert_eq!(found.is_some(), case.expected.is_some(), "{what}: {found:?}");
            continue;
        };
        let point = case.ray.at(t);
        let normal = case.primitive.normal(point);
        let turned = if normal.dot(case.ray.direction) > 0.0 { -normal } else { normal };
        assert!((t / expected.t - 1.0).abs() < 1e-14, "{what}: {t}");
        assert!(
            point.distance(expected.point) < 1e-14 * (1.0 + expected.point.length()),
            "{what}: {point}"
        );
        assert!(turned.distance(expected.normal) < 1e-13, "{what}: {turned}");
    }
}

#[test]
fn colours_are_as_they_should() {
    for case in shadings() {
        assert_eq!(case.scene.check(), Ok(()), "{}", case.name);
        let found = DVec3::from_array(render(&case.scene, 1, 1)[0]);
        let error = found.distance(case.expected);
        assert!(error < 1e-11, "{}: {}: {found}", case.name, case.report);
    }
}

/// Catches the lab report's count of 5 x 5 rays for each of 500 x 500 pixels, 6,250,000: four
/// rays of neighbouring pixels fall together.
#[test]
fn neighbours_share_their_samples() {
    let offsets: Vec<_> = samples(2).iter().map(|s| (s.dx, s.dy)).collect();
    assert_eq!(offsets.len(), 25);
    // All offsets are multiples of 1/2, so that these sums are exact.
    let mut points = HashSet::new();
    for (i, j) in (0..500).flat_map(|j| (0..500).map(move |i| (i, j))) {
        let centre = (f64::from(i) + 0.5, f64::from(j) + 0.5);
        points.extend(offsets.iter().map(|(dx, dy)| {
            (2.0 * (centre.0 + dx)) as i32 * 4096 + (2.0 * (centre.1 + dy)) as i32
        }));
    }
    assert_eq!(points.len(), 1003 * 1003);
}

// The tracer

/// The tolerance of an answer, relative to its size: 16 units of roundoff. Each answer takes about
/// a dozen roundings, those of the case's decimals among them. No case cancels or meets its surface
/// at less than 20 degrees, except for those whose numbers are exact. The worst takes 6 units.
fn tolerance(precision: Precision) -> f64 {
    16.0 * match precision {
        Precision::F32 => f64::from(f32::EPSILON) / 2.0,
        Precision::F64 => f64::EPSILON / 2.0,
    }
}

/// Catches each of the lab report's slips about a hit, in either precision.
#[test]
fn the_tracer_s_rays_hit_where_they_should() {
    for (case, precision) in RAYS.iter().flat_map(|case| PRECISIONS.map(|p| (case, p))) {
        let what = format!("{} in {precision}: {}", case.name, case.report);
        let found = caster(&of([case.primitive]), precision)
            .closest_hit(case.ray.origin, case.ray.direction);
        let (Some(hit), Some(expected)) = (found, case.expected) else {
            assert_eq!(found.is_some(), case.expected.is_some(), "{what}: {found:?}");
            continue;
        };
        let tolerance = tolerance(precision);
        assert!((hit.t / expected.t - 1.0).abs() < tolerance, "{what}: {hit:?}");
        assert!(
            hit.point.distance(expected.point) < tolerance * expected.point.length(),
            "{what}: {hit:?}"
        );
        assert!(hit.normal.distance(expected.normal) < tolerance, "{what}: {hit:?}");
        assert_eq!(hit.primitive, 0);
    }
}

/// Catches each of the lab report's slips about a colour, in either precision: along a single ray,
/// and through the camera into an image.
#[test]
fn the_tracer_s_colours_are_as_they_should() {
    for (case, precision) in shadings().iter().flat_map(|case| PRECISIONS.map(|p| (case, p))) {
        let what = format!("{} in {precision}: {}", case.name, case.report);
        let camera = case.scene.camera;
        let view = camera.look_at - camera.position;
        let seen = caster(&case.scene, precision).color(camera.position, view);
        assert!(
            DVec3::from_array(seen).distance(case.expected) < tolerance(precision),
            "{what}: {seen:?}"
        );
        // Images are kept in `f32`.
        let image = image::of_scene(&case.scene, 1, 1, precision);
        let pixel = DVec3::from_array(image.pixels()[0].map(f64::from));
        assert!(pixel.distance(case.expected) < tolerance(Precision::F32), "{what}: {pixel}");
    }
}
