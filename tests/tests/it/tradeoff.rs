//! Checks the errors, the Pareto front and the advice of a study of speed against error.

use rayweave_accuracy::ImageDifference;
use rayweave_accuracy::tradeoff::{
    Reference, Setting, TradeoffExperiment, TradeoffRow, TradeoffStudy,
};
use rayweave_contract::{Image, Work};
use rayweave_core::{Sampling, Scene};
use rayweave_measure::Protocol;
use rayweave_tests::{image, model, scenes};
use std::time::Duration;

const SIZE: (u32, u32) = (20, 15);

fn render(work: &dyn Work) -> Result<Image, String> {
    Ok(image::pixel_by_pixel(work, SIZE.0, SIZE.1))
}

/// Runs a study of one round: nothing here is about time.
fn study(scene: &Scene) -> TradeoffStudy {
    let protocol =
        Protocol { min_rounds: 1, max_rounds: 1, budget: Duration::ZERO, goal: None, seed: 1 };
    let strategy = rayweave_registry::reference();
    TradeoffExperiment { scene, size: SIZE, strategy, protocol }
        .run(render, |_| ())
        .expect("a study")
}

fn rendered(scene: &Scene, setting: Setting) -> Image {
    render(&*setting.work(scene, SIZE).expect("a sound scene")).expect("an image")
}

/// Catches the errors of another setting, an arithmetic compared with other rays, and a front or
/// an advice that does not follow from times and errors.
#[test]
fn each_row_is_of_its_setting() {
    let scene = scenes::named("room");
    let study = study(&scene);
    assert!(study.repeatable);
    assert_eq!((study.rounds, study.rows.len()), (1, 4 * (13 * 3 + 5)));
    let truth = &study.reference.image;
    for row in &study.rows {
        let found = rendered(&scene, row.setting);
        assert_eq!(row.error, ImageDifference::between(truth, &found), "{}", row.setting);
        let exact = Setting { arithmetic: study.rows[0].setting.arithmetic, ..row.setting };
        let arithmetic = ImageDifference::between(&rendered(&scene, exact), &found).rmse;
        assert_eq!(row.arithmetic_rmse, arithmetic, "{}", row.setting);
        let deep = Setting { max_reflections: scene.render.max_reflections, ..exact };
        assert_eq!(
            row.sampling_rmse,
            ImageDifference::between(truth, &rendered(&scene, deep)).rmse
        );
        assert_eq!(row.samples_ns.len(), 1);
    }
    let beats = |a: &TradeoffRow, b: &TradeoffRow| {
        a.median_ns < b.median_ns && a.error.psnr() > b.error.psnr() + 0.1
    };
    for row in study.rows.iter().filter(|row| row.in_front) {
        assert!(!study.rows.iter().any(|other| beats(other, row)), "{} is beaten", row.setting);
    }
    let best = study.rows.iter().map(|row| row.error.psnr()).fold(0.0, f64::max);
    assert!(study.fastest_with(best).is_some() && study.fastest_with(best + 0.1).is_none());
    let chosen = study.fastest_with(35.0).expect("there is one");
    let faster = |row: &&TradeoffRow| row.error.psnr() >= 35.0 && row.median_ns < chosen.median_ns;
    assert!(chosen.error.psnr() >= 35.0 && study.rows.iter().find(faster).is_none());
    let own = study.report_row();
    assert_eq!((own.setting.rays_per_pixel(), own.setting.sampling), (25, Sampling::Lattice));
    let parts: Vec<&str> = study.costs.iter().map(|cost| cost.part).collect();
    assert_eq!(parts, ["whole scene", "planes", "spheres", "triangles", "cylinders"]);
}

/// Catches a reference that is not the filter's limit, and an estimate of its error that is too
/// low: the model comes ever nearer to the reference with a denser lattice, down to the error of
/// its own endpoints.
#[test]
fn the_reference_is_the_limit() {
    let mut scene = scenes::named("lab");
    let reference = Reference::new(&scene, SIZE, render).expect("a sound scene");
    let mut last = 0.0;
    for density in [2, 4, 8, 16] {
        scene.render.antialiasing = density;
        let psnr = image::psnr(&model::render(&scene, SIZE.0, SIZE.1), &reference.image);
        assert!(psnr > last + 2.0, "{psnr} dB at a density of {density}, {last} before");
        last = psnr;
    }
    assert!(last > 60.0, "{last} dB");
    assert!((1e-6..1e-4).contains(&reference.uncertainty), "{}", reference.uncertainty);
}

/// Catches samples of the wrong weight or in the wrong place: with no more rays than the lattice
/// sampling by importance is nearer to the limit, in each of the scenes.
#[test]
fn importance_is_nearer_with_as_many_rays() {
    for name in scenes::NAMES {
        let scene = scenes::named(name);
        let reference = Reference::new(&scene, SIZE, render).expect("a sound scene");
        let measured = |sampling, antialiasing| {
            let own = Setting::report(scene.render.max_reflections);
            let setting = Setting { sampling, antialiasing, ..own };
            let error = ImageDifference::between(&reference.image, &rendered(&scene, setting)).rmse;
            (setting.rays_per_pixel(), error)
        };
        for density in [2, 3, 4] {
            let (lattice_rays, lattice) = measured(Sampling::Lattice, density);
            let (rays, importance) = measured(Sampling::Importance, density + 1);
            assert!(rays <= lattice_rays);
            assert!(
                importance < 0.9 * lattice,
                "{name}: {rays} rays: {importance}, lattice: {lattice}"
            );
        }
    }
}
