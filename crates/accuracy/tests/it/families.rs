//! Properties that hold in every family, on fresh seeds.

use std::collections::HashSet;

use rayweave_accuracy::oracle::INFINITE;
use rayweave_accuracy::{FAMILIES, Family, HardCase, generate};

fn drawn(name: &str, count: usize) -> Vec<HardCase> {
    let family = Family::named(name).expect("a family");
    [11, 12, 13].into_iter().flat_map(|seed| generate(family, seed, count)).collect()
}

fn hits(cases: &[HardCase]) -> usize {
    cases.iter().filter(|case| case.expect.as_ref().is_some_and(|expect| expect.is_hit())).count()
}

#[test]
fn names_and_ids_are_unique() {
    let names: HashSet<&str> = FAMILIES.iter().map(|family| family.name).collect();
    assert_eq!(names.len(), 36);
    let ids: HashSet<String> =
        FAMILIES.iter().flat_map(|family| generate(family, 5, 3)).map(|case| case.id).collect();
    assert_eq!(ids.len(), 108);
}

#[test]
fn a_case_depends_on_family_seed_and_index_alone() {
    let family = Family::named("sphere_graze").expect("a family");
    assert_eq!(generate(family, 3, 10)[..4], generate(family, 3, 4));
    assert_ne!(generate(family, 3, 1)[0].ray, generate(family, 4, 1)[0].ray);
}

#[test]
fn families_that_always_hit_or_miss_do() {
    for name in ["sphere_inside", "mesh_edge", "mesh_vertex", "mesh_closed", "cyl_far_wall"] {
        let cases = drawn(name, 50);
        assert_eq!(hits(&cases), cases.len(), "{name}");
        assert!(cases.iter().all(|case| case.decidable), "{name}");
    }
    for name in ["sphere_behind", "tri_degenerate", "flat_surface_exact", "invalid_input"] {
        assert_eq!(hits(&drawn(name, 50)), 0, "{name}");
    }
}

#[test]
fn the_other_families_both_hit_and_miss() {
    let one_sided =
        ["sphere_inside", "cyl_far_wall", "sphere_behind", "tri_degenerate", "flat_surface_exact"];
    for family in &FAMILIES {
        if one_sided.contains(&family.name)
            || family.name.starts_with("mesh")
            || family.name == "invalid_input"
        {
            continue;
        }
        let cases = drawn(family.name, 50);
        let share = hits(&cases) as f64 / cases.len() as f64;
        assert!((0.1..0.98).contains(&share), "{}: {share} of the rays hit", family.name);
    }
}

#[test]
fn exact_cases_are_exact() {
    // The start is exactly on the surface, so only the direction decides the verdict.
    for name in ["sphere_surface_exact", "cyl_surface_exact", "flat_surface_exact"] {
        let cases = drawn(name, 50);
        let decidable = cases.iter().filter(|case| case.decidable).count();
        assert!(decidable * 20 >= cases.len() * 19, "{name}: {decidable}");
    }
    for name in ["tri_degenerate", "invalid_input"] {
        assert!(drawn(name, 50).iter().all(|case| case.margin == INFINITE), "{name}");
    }
    assert!(drawn("tri_degenerate", 50).iter().all(|case| case.note.ends_with("; degenerate")));
    assert!(
        drawn("flat_surface_exact", 50)
            .iter()
            .all(|case| case.note.ends_with("; behind") || case.note.ends_with("; outside"))
    );
}

#[test]
fn hard_families_are_hard_and_controls_are_not() {
    for name in [
        "sphere_graze",
        "cyl_graze",
        "tri_needle",
        "tri_sliver",
        "sphere_far",
        "cyl_far",
        "tri_edge",
    ] {
        let cases = drawn(name, 50);
        let borderline = cases.iter().filter(|case| !case.decidable).count();
        assert!(
            borderline * 6 > cases.len() && borderline * 3 < cases.len() * 2,
            "{name}: {borderline}"
        );
    }
    for name in
        ["plane_basic", "sphere_basic", "tri_basic", "cyl_basic", "sphere_inside", "scale_scene"]
    {
        assert!(drawn(name, 50).iter().filter(|case| !case.decidable).count() <= 1, "{name}");
    }
    let largest = |name| drawn(name, 50).iter().map(|case| case.cond).fold(0.0, f64::max);
    for name in ["plane_parallel", "sphere_ground", "tri_needle", "tri_sliver", "cyl_huge"] {
        assert!(largest(name) > 1e4, "{name}: {}", largest(name));
    }
    assert!(largest("sphere_far") < 100.0 && largest("cyl_far_wall") < 10.0);
}
