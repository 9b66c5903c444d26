//! The scenes that are hard for arithmetic, and the lab report's at every scale and place, are
//! rendered right in the precision that is chosen for each.

use glam::DVec3;
use rayweave_contract::Image;
use rayweave_core::precision::PrecisionEstimate;
use rayweave_core::{Precision, Scene};
use rayweave_tests::transform::{enlarged, moved};
use rayweave_tests::{image, model, scenes};

/// The goal for a scene in `scenes/hard`.
struct Goal {
    /// The name of the file, without the ending.
    name: &'static str,
    /// The precision that is chosen for the scene.
    precision: Precision,
    /// True if a green pixel is a leak.
    closed: bool,
}

const fn goal(name: &'static str, precision: Precision) -> Goal {
    Goal { name, precision, closed: false }
}

/// All goals, in the order of the names.
const GOALS: [Goal; 11] = [
    Goal { closed: true, ..goal("fan", Precision::F32) },
    goal("globe", Precision::F64),
    goal("grazing", Precision::F32),
    goal("inside", Precision::F32),
    goal("mirrors", Precision::F32),
    goal("moved-1e5", Precision::F64),
    goal("needles", Precision::F32),
    goal("scaled-1e-3", Precision::F32),
    goal("scaled-1e3", Precision::F32),
    goal("scaled-1e5", Precision::F32),
    goal("telephoto", Precision::F64),
];

/// The least PSNR in dB against `f64` and against the model: a mean error of a quarter of a step of
/// 8 bits.
const ALIKE: f64 = 60.0;

/// An image in the chosen precision, in `f64` and of the model.
struct Drawn {
    width: u32,
    precision: Precision,
    chosen: Image,
    wide: Image,
    truth: Vec<[f64; 3]>,
}

impl Drawn {
    fn new(scene: &Scene, width: u32, antialiasing: u32) -> Self {
        let mut scene = scene.clone();
        scene.render.antialiasing = antialiasing;
        let height = width * 3 / 4;
        let precision = PrecisionEstimate::of(&scene).precision();
        let chosen = image::of_scene(&scene, width, height, precision);
        let wide = match precision {
            Precision::F32 => image::of_scene(&scene, width, height, Precision::F64),
            Precision::F64 => chosen.clone(),
        };
        Self { width, precision, chosen, wide, truth: model::render(&scene, width, height) }
    }

    /// The PSNR of the chosen image against that in `f64`, and against the model.
    fn agreement(&self) -> [f64; 2] {
        let wide: Vec<_> = self.wide.pixels().iter().map(|color| color.map(f64::from)).collect();
        [&wide, &self.truth].map(|truth| image::psnr(truth, &self.chosen))
    }

    /// Lists the pixels that are plainly wrong amid others that are all alike in the model, where
    /// no outline and no edge of a shadow explains them.
    fn acne(&self) -> Vec<(u32, u32)> {
        let (width, height) =
            (self.width as usize, self.chosen.pixels().len() / self.width as usize);
        let apart =
            |a: [f64; 3], b: [f64; 3]| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max);
        let wrong = |index: &usize| {
            let (x, y) = (index % width, index / width);
            let right = self.truth[*index];
            let around = (y.saturating_sub(1)..(y + 2).min(height)).flat_map(|y| {
                (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x)
            });
            let alike = around.map(|i| apart(self.truth[i], right)).fold(0.0, f64::max) < 0.02;
            alike && apart(self.chosen.pixels()[*index].map(f64::from), right) > 0.04
        };
        let found = (0..self.truth.len()).filter(wrong);
        found.map(|index| self.chosen.position(index)).collect()
    }

    #[track_caller]
    fn assert_right(&self, what: &str) {
        let [wide, model] = self.agreement();
        let found = format!(
            "{what} in {}: {wide:.1} dB against f64, {model:.1} dB against the model",
            self.precision
        );
        assert!(wide >= ALIKE && model >= ALIKE, "{found}");
        assert!(self.acne().is_empty(), "{found}, acne at {:?}", self.acne());
    }
}

/// Asserts that nothing behind the triangles is visible: all of it is green.
#[track_caller]
fn assert_closed(what: &str, scene: &Scene) {
    let mut scene = scene.clone();
    scene.render.antialiasing = 0;
    for precision in [PrecisionEstimate::of(&scene).precision(), Precision::F64] {
        // An odd number of pixels: some lie on the axes.
        let image = image::of_scene(&scene, 125, 93, precision);
        let leaks = image.pixels().iter().filter(|color| color[1] != 0.0).count();
        assert_eq!(leaks, 0, "{what}, in {precision}: pixels that are partly green");
    }
}

/// Catches a scene without a goal, and a goal without its scene.
#[test]
fn every_hard_scene_has_its_goal() {
    assert_eq!(scenes::hard(), GOALS.map(|goal| goal.name));
}

/// Catches errors of the tracer where arithmetic is hard: a wrong choice of precision, surfaces
/// that shadow or mirror themselves, edges that let light through.
#[test]
fn hard_scenes_are_rendered_right() {
    for Goal { name, precision, .. } in GOALS {
        let drawn = Drawn::new(&scenes::named(&format!("hard/{name}")), 160, 1);
        assert_eq!(drawn.precision, precision, "{name}");
        drawn.assert_right(name);
    }
}

/// Catches the same without a filter that spreads a wrong sample, and `f64` chosen for nothing.
#[test]
fn hard_scenes_have_no_wrong_samples() {
    for Goal { name, precision, closed, .. } in GOALS {
        let scene = scenes::named(&format!("hard/{name}"));
        let drawn = Drawn::new(&scene, 200, 0);
        assert!(drawn.acne().is_empty(), "{name}: acne at {:?}", drawn.acne());
        if closed {
            assert_closed(name, &scene);
        }
        if precision == Precision::F64 {
            let mut scene = scene;
            scene.render.antialiasing = 0;
            let narrow = image::of_scene(&scene, 200, 150, Precision::F32);
            let narrow = image::psnr(&drawn.truth, &narrow);
            assert!(narrow < 66.0, "{name}: f32 would do, with {narrow:.1} dB");
        }
    }
}

/// Lists the lab report's scene and the fan, in all sizes and places that are tried.
fn everywhere() -> Vec<(String, Scene)> {
    let mut all = Vec::new();
    for name in ["lab", "hard/fan"] {
        let scene = scenes::named(name);
        for exponent in -4..=6 {
            let scale = 10f64.powi(exponent);
            all.push((format!("{name}, {scale:e} times as large"), enlarged(&scene, scale)));
        }
        for offset in [1.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 1e5, 1e6] {
            all.push((
                format!("{name}, moved by {offset}"),
                moved(&scene, offset * DVec3::new(1.0, -1.0, 1.0)),
            ));
        }
    }
    all
}

/// Catches a constant where a bound follows the coordinates, an offset bound that is too small or a
/// choice of precision that comes too late.
#[test]
fn scale_and_place_are_not_seen() {
    for (what, scene) in everywhere() {
        Drawn::new(&scene, 100, 1).assert_right(&what);
    }
}

/// Catches an edge that two triangles leave to each other. From the axis of the funnel, a row and a
/// column of rays meet its edges to the last bit, and one ray its tip.
#[test]
fn the_fan_is_closed_at_every_scale_and_place() {
    for (what, scene) in everywhere() {
        if !what.starts_with("hard/fan") {
            continue;
        }
        assert_closed(&what, &scene);
        let mut on_axis = scene;
        let tip = on_axis.triangles[0].vertices[0];
        on_axis.camera.look_at = tip;
        on_axis.camera.position = tip.with_z(on_axis.camera.position.z);
        assert_closed(&format!("{what}, from its axis"), &on_axis);
    }
}
