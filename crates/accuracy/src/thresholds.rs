//! Thresholds for the score of a kernel in each family of hard cases, in three tiers.

use std::fmt;

use crate::score::FamilyScore;

/// The arithmetic of a kernel, which determines the thresholds that it must keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// f32 with one rounding per operation. It allows no wrong verdict on a decidable case, no
    /// leak, and the error of a backward stable formula: 2 ulps per unit of the condition number.
    Plain32,
    /// f32 with error-free transforms (two-sum, two-product). It allows the same, and at most
    /// 6 ulps wherever compensation removes the condition number: see [`Tier::thresholds`].
    Compensated32,
    /// f64. It allows no wrong verdict, not even on borderline cases, and an error of `t` of 0.51
    /// ulps of f32: rounded to f32, `t` is the nearest number, except for ties.
    Double,
}

/// Limits on the measures of a family; `None` where there is no limit. A measure may equal its
/// limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Thresholds {
    /// The limit of [`FamilyScore::wrong`].
    pub wrong: Option<f64>,
    /// The limit of [`FamilyScore::wrong_borderline`].
    pub wrong_borderline: Option<f64>,
    /// The limit of [`FamilyScore::gross`].
    pub gross: Option<f64>,
    /// The limit of [`FamilyScore::leaks`].
    pub leaks: Option<f64>,
    /// The limit of [`FamilyScore::max`], in ulps.
    pub max: Option<f64>,
    /// The limit of [`FamilyScore::max_by_condition`], in ulps.
    pub max_by_condition: Option<f64>,
}

/// A threshold that a kernel exceeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// The name of the measure.
    pub measure: &'static str,
    /// The measured value.
    pub found: f64,
    /// The largest value allowed.
    pub limit: f64,
}

/// Families in which error-free transforms remove the condition number. It is large there because a
/// difference of products cancels (near a plane, far from a small sphere, close above a huge one,
/// on a surface), and compensation makes that difference exact. The other families get it from the
/// root itself (grazing rays) or from the triangle's normal (needles, slivers). The remaining
/// controls are left out too, because a large condition number is rare there.
const COMPENSATED: [&str; 19] = [
    "plane_basic",
    "plane_parallel",
    "plane_far",
    "sphere_far",
    "sphere_ground",
    "sphere_inside",
    "sphere_surface_exact",
    "sphere_surface_round",
    "offset_scene",
    "tri_tiny_far",
    "tri_edge",
    "cyl_parallel",
    "cyl_rim",
    "cyl_far_wall",
    "cyl_inside",
    "cyl_huge",
    "cyl_far",
    "cyl_surface_exact",
    "cyl_surface_round",
];
/// Families in which the sign of one compensated difference decides every borderline case: the side
/// of the surface to which the origin was rounded.
const DECIDED_BY_COMPENSATION: [&str; 2] = ["sphere_surface_round", "cyl_surface_round"];
/// Families in which only the verdict counts, not `t`. Rounding decides which of two triangles that
/// share an edge is hit, and their distances differ.
const MESHES: [&str; 3] = ["mesh_edge", "mesh_vertex", "mesh_closed"];

impl Tier {
    /// All tiers, the least demanding first.
    pub const ALL: [Self; 3] = [Self::Plain32, Self::Compensated32, Self::Double];

    /// Returns `plain32`, `eft32` or `f64`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain32 => "plain32",
            Self::Compensated32 => "eft32",
            Self::Double => "f64",
        }
    }

    /// Returns the tier with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tier| tier.name() == name)
    }

    /// Returns the thresholds of this family; those common to all for an unknown family.
    #[must_use]
    pub fn thresholds(self, family: &str) -> Thresholds {
        let mesh = MESHES.contains(&family);
        let verdicts =
            Thresholds { wrong: Some(0.0), leaks: mesh.then_some(0.0), ..Thresholds::default() };
        match self {
            Self::Double => Thresholds { wrong_borderline: Some(0.0), max: Some(0.51), ..verdicts },
            _ if mesh => Thresholds { gross: Some(0.0), ..verdicts },
            Self::Plain32 => Thresholds { max_by_condition: Some(2.0), ..verdicts },
            Self::Compensated32 => Thresholds {
                max_by_condition: Some(2.0),
                max: COMPENSATED.contains(&family).then_some(6.0),
                wrong_borderline: DECIDED_BY_COMPENSATION.contains(&family).then_some(0.0),
                ..verdicts
            },
        }
    }

    /// Returns the thresholds that a kernel exceeded in a family. A measure without a value exceeds
    /// none.
    #[must_use]
    pub fn exceeded(self, score: &FamilyScore) -> Vec<Exceeded> {
        let thresholds = self.thresholds(&score.family);
        let measures = [
            ("wrong", Some(score.wrong as f64), thresholds.wrong),
            ("wrong borderline", Some(score.wrong_borderline as f64), thresholds.wrong_borderline),
            ("gross", Some(score.gross as f64), thresholds.gross),
            ("leaks", Some(score.leaks as f64), thresholds.leaks),
            ("max", score.max, thresholds.max),
            ("max / cond", score.max_by_condition, thresholds.max_by_condition),
        ];
        let over = |(measure, found, limit): (&'static str, Option<f64>, Option<f64>)| {
            let (found, limit) = found.zip(limit)?;
            (found > limit).then_some(Exceeded { measure, found, limit })
        };
        measures.into_iter().filter_map(over).collect()
    }
}

impl fmt::Display for Tier {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::Family;

    #[test]
    fn the_exceptions_name_families() {
        for name in COMPENSATED.iter().chain(&DECIDED_BY_COMPENSATION).chain(&MESHES) {
            assert!(Family::named(name).is_some(), "{name}");
        }
    }

    #[test]
    fn a_measure_at_its_limit_is_within_it() {
        let mut score =
            FamilyScore { family: "cyl_far".into(), max: Some(6.0), ..FamilyScore::default() };
        assert!(Tier::Compensated32.exceeded(&score).is_empty());
        score.max = Some(6.5);
        let exceeded = Exceeded { measure: "max", found: 6.5, limit: 6.0 };
        assert_eq!(Tier::Compensated32.exceeded(&score), [exceeded]);
        assert!(Tier::Plain32.exceeded(&score).is_empty());
        assert_eq!(Tier::Double.exceeded(&score), [Exceeded { limit: 0.51, ..exceeded }]);
        assert_eq!(Tier::named("eft32"), Some(Tier::Compensated32));
        assert_eq!(Tier::named("f32"), None);
    }
}
