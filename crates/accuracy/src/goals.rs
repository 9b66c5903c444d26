//! What a kernel must reach in each family: the goals of three tiers.

use std::fmt;

use crate::score::FamilyScore;

/// What a kernel computes with, and so what can be asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// f32, one rounding an operation. No wrong verdict on a decidable case, no leak, and the error
    /// of a backward stable formula: 2 ulps for every unit of the condition number.
    Plain32,
    /// f32 with error-free transforms (two-sum, two-product). The same, and 6 ulps at most wherever
    /// compensation removes the condition number: see [`Tier::goals`].
    Compensated32,
    /// f64. No wrong verdict at all, borderline cases included, and a `t` right to 0.51 ulps of
    /// f32: rounded to f32 it is the nearest one, but for ties.
    Double,
}

/// Limits on the measures of a family; `None` where any value will do. Equality is within the
/// limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goals {
    /// Of [`FamilyScore::wrong`].
    pub wrong: Option<f64>,
    /// Of [`FamilyScore::wrong_borderline`].
    pub wrong_borderline: Option<f64>,
    /// Of [`FamilyScore::gross`].
    pub gross: Option<f64>,
    /// Of [`FamilyScore::leaks`].
    pub leaks: Option<f64>,
    /// Of [`FamilyScore::max`], in ulps.
    pub max: Option<f64>,
    /// Of [`FamilyScore::max_by_condition`], in ulps.
    pub max_by_condition: Option<f64>,
}

/// A goal that was not reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Missed {
    /// What was measured.
    pub measure: &'static str,
    /// How much it is.
    pub found: f64,
    /// How much it may be.
    pub limit: f64,
}

/// Where error-free transforms remove the condition number. It is large there because a difference
/// of products cancels (near a plane, far from a small sphere, close above a huge one, on a
/// surface), and that difference is then exact. Elsewhere it is in the root itself (grazing rays)
/// or in the triangle's normal (needles, slivers), or a control, where a rare large condition
/// number is not chased.
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
/// Where the sign of one compensated difference decides every borderline case: on which side of the
/// surface the origin was rounded to.
const DECIDED_BY_COMPENSATION: [&str; 2] = ["sphere_surface_round", "cyl_surface_round"];
/// Where the verdict is of interest, not `t`: which of two triangles that share an edge is hit is
/// left to rounding, and their distances differ.
const MESHES: [&str; 3] = ["mesh_edge", "mesh_vertex", "mesh_closed"];

impl Tier {
    /// All tiers, the least demanding first.
    pub const ALL: [Self; 3] = [Self::Plain32, Self::Compensated32, Self::Double];

    /// `plain32`, `eft32` or `f64`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain32 => "plain32",
            Self::Compensated32 => "eft32",
            Self::Double => "f64",
        }
    }

    /// The tier of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tier| tier.name() == name)
    }

    /// What is asked of a kernel in this family; in an unknown family, what is asked everywhere.
    #[must_use]
    pub fn goals(self, family: &str) -> Goals {
        let mesh = MESHES.contains(&family);
        let verdicts = Goals { wrong: Some(0.0), leaks: mesh.then_some(0.0), ..Goals::default() };
        match self {
            Self::Double => Goals { wrong_borderline: Some(0.0), max: Some(0.51), ..verdicts },
            _ if mesh => Goals { gross: Some(0.0), ..verdicts },
            Self::Plain32 => Goals { max_by_condition: Some(2.0), ..verdicts },
            Self::Compensated32 => Goals {
                max_by_condition: Some(2.0),
                max: COMPENSATED.contains(&family).then_some(6.0),
                wrong_borderline: DECIDED_BY_COMPENSATION.contains(&family).then_some(0.0),
                ..verdicts
            },
        }
    }

    /// The goals that a kernel missed in a family. What could not be measured is not missed.
    #[must_use]
    pub fn missed(self, score: &FamilyScore) -> Vec<Missed> {
        let goals = self.goals(&score.family);
        let measures = [
            ("wrong", Some(score.wrong as f64), goals.wrong),
            ("wrong borderline", Some(score.wrong_borderline as f64), goals.wrong_borderline),
            ("gross", Some(score.gross as f64), goals.gross),
            ("leaks", Some(score.leaks as f64), goals.leaks),
            ("max", score.max, goals.max),
            ("max / cond", score.max_by_condition, goals.max_by_condition),
        ];
        let over = |(measure, found, limit): (&'static str, Option<f64>, Option<f64>)| {
            let (found, limit) = found.zip(limit)?;
            (found > limit).then_some(Missed { measure, found, limit })
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
        assert!(Tier::Compensated32.missed(&score).is_empty());
        score.max = Some(6.5);
        let missed = Missed { measure: "max", found: 6.5, limit: 6.0 };
        assert_eq!(Tier::Compensated32.missed(&score), [missed]);
        assert!(Tier::Plain32.missed(&score).is_empty());
        assert_eq!(Tier::Double.missed(&score), [Missed { limit: 0.51, ..missed }]);
        assert_eq!(Tier::named("eft32"), Some(Tier::Compensated32));
        assert_eq!(Tier::named("f32"), None);
    }
}
