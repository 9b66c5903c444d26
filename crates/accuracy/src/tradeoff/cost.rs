//! What the arithmetics cost: on a whole scene, and on each kind of primitive in it.

use super::setting::ARITHMETICS;
use super::{Setting, Subject, ratio};
use rayweave_core::{Arithmetic, Formulas, Precision, Scene};
use rayweave_measure::Interval;

/// Ratios of times, within a round, of images with 25 rays a pixel and all bounces.
#[derive(Clone, Copy, Debug)]
pub struct ArithmeticCost {
    /// What is in the image: "whole scene", or one kind of primitive alone.
    pub part: &'static str,
    /// Robust formulas over the textbook's, in `f32`.
    pub robust_f32: Interval,
    /// The same in `f64`.
    pub robust_f64: Interval,
    /// `f64` over `f32`, with robust formulas.
    pub f64_robust: Interval,
}

/// The scene with one kind of primitive at a time.
pub(super) struct Parts(Vec<(&'static str, Scene)>);

impl Parts {
    pub(super) fn of(scene: &Scene) -> Self {
        let empty = Scene {
            planes: Vec::new(),
            spheres: Vec::new(),
            triangles: Vec::new(),
            cylinders: Vec::new(),
            ..scene.clone()
        };
        let parts = [
            (
                "planes",
                scene.planes.is_empty(),
                Scene { planes: scene.planes.clone(), ..empty.clone() },
            ),
            (
                "spheres",
                scene.spheres.is_empty(),
                Scene { spheres: scene.spheres.clone(), ..empty.clone() },
            ),
            (
                "triangles",
                scene.triangles.is_empty(),
                Scene { triangles: scene.triangles.clone(), ..empty.clone() },
            ),
            (
                "cylinders",
                scene.cylinders.is_empty(),
                Scene { cylinders: scene.cylinders.clone(), ..empty },
            ),
        ];
        Self(
            parts
                .into_iter()
                .filter(|part| !part.1)
                .map(|(name, _, scene)| (name, scene))
                .collect(),
        )
    }

    /// Each part in all arithmetics, with the report's rays.
    pub(super) fn subjects(&self) -> impl Iterator<Item = Subject<'_>> {
        self.0.iter().flat_map(|(_, scene)| {
            let report = Setting::report(scene.render.max_reflections);
            ARITHMETICS.map(|arithmetic| Subject::new(scene, Setting { arithmetic, ..report }))
        })
    }

    /// From the times of the settings, and after them those of [`Parts::subjects`].
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
