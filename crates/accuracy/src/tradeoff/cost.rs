//! The cost of each arithmetic, on a whole scene and on each kind of primitive in it.

use super::setting::ARITHMETICS;
use super::{Setting, Subject, ratio};
use rayweave_core::{Arithmetic, Formulas, Precision, Scene};
use rayweave_measure::Interval;
use serde::Serialize;

/// Ratios of times within a round, of images with 25 rays per pixel and all bounces.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ArithmeticCost {
    /// The content of the image: "whole scene", or the name of one kind of primitive.
    pub part: &'static str,
    /// Robust over textbook formulas, in `f32`.
    #[serde(rename = "robust_over_textbook_f32")]
    pub robust_f32: Interval,
    /// Robust over textbook formulas, in `f64`.
    #[serde(rename = "robust_over_textbook_f64")]
    pub robust_f64: Interval,
    /// `f64` over `f32`, with robust formulas.
    #[serde(rename = "f64_over_f32_robust")]
    pub f64_robust: Interval,
}

/// The scene with one kind of primitive at a time, and the name of that kind.
pub(super) struct Parts(Vec<(&'static str, Scene)>);

impl Parts {
    pub(super) fn of(scene: &Scene) -> Self {
        let Scene { planes, spheres, triangles, cylinders, .. } = scene.clone();
        let empty = Scene {
            planes: Vec::new(),
            spheres: Vec::new(),
            triangles: Vec::new(),
            cylinders: Vec::new(),
            ..scene.clone()
        };
        let parts = [
            ("planes", planes.len(), Scene { planes, ..empty.clone() }),
            ("spheres", spheres.len(), Scene { spheres, ..empty.clone() }),
            ("triangles", triangles.len(), Scene { triangles, ..empty.clone() }),
            ("cylinders", cylinders.len(), Scene { cylinders, ..empty }),
        ];
        let present = parts.into_iter().filter(|&(_, count, _)| count > 0);
        Self(present.map(|(name, _, scene)| (name, scene)).collect())
    }

    /// Returns each part in all arithmetics, with the rays of the lab report's own setting.
    pub(super) fn subjects(&self) -> impl Iterator<Item = Subject<'_>> {
        self.0.iter().flat_map(|(_, scene)| {
            let report = Setting::report(scene.render.max_reflections);
            ARITHMETICS.map(|arithmetic| Subject::new(scene, Setting { arithmetic, ..report }))
        })
    }

    /// Computes the costs from `times`: those of the settings, then those of [`Parts::subjects`].
    pub(super) fn costs(&self, settings: &[Setting], times: &[&[u64]]) -> Vec<ArithmeticCost> {
        let report = Setting::report(settings[0].max_reflections);
        let whole = |arithmetic| {
            let place = settings.iter().position(|s| *s == Setting { arithmetic, ..report });
            times[place.expect("among the settings")]
        };
        let mut costs = vec![cost("whole scene", whole)];
        for (&(part, _), times) in
            self.0.iter().zip(times[settings.len()..].chunks(ARITHMETICS.len()))
        {
            costs.push(cost(part, |arithmetic| {
                let place = ARITHMETICS.iter().position(|known| *known == arithmetic);
                times[place.expect("among the arithmetics")]
            }));
        }
        costs
    }
}

fn cost<'a>(part: &'static str, times: impl Fn(Arithmetic) -> &'a [u64]) -> ArithmeticCost {
    use Formulas::{Robust, Textbook};
    use Precision::{F32, F64};
    let of = |formulas, precision| times(Arithmetic { formulas, precision });
    ArithmeticCost {
        part,
        robust_f32: ratio(of(Robust, F32), of(Textbook, F32)),
        robust_f64: ratio(of(Robust, F64), of(Textbook, F64)),
        f64_robust: ratio(of(Robust, F64), of(Robust, F32)),
    }
}
