//! The case format: one ray against one primitive, and the exact answer, a JSON object a line.

mod number;

use std::io::{self, BufRead, Write};

use serde::{Deserialize, Serialize};

use crate::decimal::Decimal;
use crate::json_lines::{self, ReadError};

/// One ray against one primitive.
///
/// Every number of `primitive` and `ray` is an f32: a kernel in f64 widens it. Equality follows
/// IEEE 754, so that a case with a NaN in it differs from itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HardCase {
    /// The family it belongs to: see [`crate::families`].
    pub family: String,
    /// Its name, different from every other in a file.
    pub id: String,
    /// What is aimed at.
    pub primitive: Primitive,
    /// The ray.
    pub ray: Ray,
    /// The exact answer; `None` where nobody has computed it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<Expect>,
    /// Whether a good f32 kernel must get the verdict right: see [`crate::oracle`].
    #[serde(default)]
    pub decidable: bool,
    /// The relative condition number of `t`, 0 on a miss, 9.9e99 for infinite.
    #[serde(default)]
    pub cond: f64,
    /// Distance to the nearest other verdict, in f32 ulps of the inputs, 9.9e99 for infinite.
    #[serde(default)]
    pub margin: f64,
    /// What makes it hard, for people.
    #[serde(default)]
    pub note: String,
}

/// `origin + t direction`; the direction is of any length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ray {
    /// Where it starts.
    #[serde(with = "number::vector")]
    pub origin: [f32; 3],
    /// Where it goes; `t` is in units of it.
    #[serde(with = "number::vector")]
    pub direction: [f32; 3],
}

/// What a ray is aimed at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Primitive {
    /// An infinite plane.
    Plane {
        /// Any point of it.
        #[serde(with = "number::vector")]
        point: [f32; 3],
        /// Its normal, not unit in general.
        #[serde(with = "number::vector")]
        normal: [f32; 3],
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        #[serde(with = "number::vector")]
        center: [f32; 3],
        /// Its radius.
        #[serde(with = "number::scalar")]
        radius: f32,
    },
    /// A triangle, edges and vertices included.
    Triangle {
        /// The first vertex.
        #[serde(with = "number::vector")]
        a: [f32; 3],
        /// The second vertex.
        #[serde(with = "number::vector")]
        b: [f32; 3],
        /// The third vertex.
        #[serde(with = "number::vector")]
        c: [f32; 3],
    },
    /// The wall of a cylinder around a vertical axis, rims included, no caps.
    Cylinder {
        /// The lower end of its axis.
        #[serde(with = "number::vector")]
        bottom: [f32; 3],
        /// The upper end: `bottom` but for a greater y.
        #[serde(with = "number::vector")]
        top: [f32; 3],
        /// Its radius.
        #[serde(with = "number::scalar")]
        radius: f32,
    },
    /// Triangles that share edges and vertices; the nearest hit of any of them counts.
    Mesh {
        /// The three vertices of each.
        #[serde(with = "number::triangles")]
        triangles: Vec<[[f32; 3]; 3]>,
    },
}

/// The exact answer to a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "RawExpect", into = "RawExpect")]
pub enum Expect {
    /// Nothing is hit.
    Miss,
    /// The primitive is hit.
    Hit {
        /// How far along the ray, in units of its direction.
        t: Decimal,
        /// Where.
        point: Box<[Decimal; 3]>,
        /// The unit normal: as given for a plane, outward for sphere and cylinder, along
        /// `(b - a) x (c - a)` for a triangle; not turned towards the ray.
        normal: Box<[Decimal; 3]>,
    },
    /// A triangle of the mesh is hit, one at least.
    MeshHit {
        /// The nearest.
        t: Decimal,
    },
}

impl Expect {
    /// Whether anything is hit.
    #[must_use]
    pub fn is_hit(&self) -> bool {
        !matches!(self, Self::Miss)
    }

    /// Where on the ray, on a hit.
    #[must_use]
    pub fn t(&self) -> Option<&Decimal> {
        match self {
            Self::Miss => None,
            Self::Hit { t, .. } | Self::MeshHit { t } => Some(t),
        }
    }
}

/// [`Expect`] as it is written.
#[derive(Default, Serialize, Deserialize)]
struct RawExpect {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hit: Option<bool>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    min_hits: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    t: Option<Decimal>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    point: Option<Box<[Decimal; 3]>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    normal: Option<Box<[Decimal; 3]>>,
}

impl TryFrom<RawExpect> for Expect {
    type Error = &'static str;

    fn try_from(raw: RawExpect) -> Result<Self, &'static str> {
        match raw {
            RawExpect { hit: Some(false), .. } => Ok(Self::Miss),
            RawExpect {
                hit: Some(true),
                t: Some(t),
                point: Some(point),
                normal: Some(normal),
                ..
            } => Ok(Self::Hit { t, point, normal }),
            RawExpect { hit: Some(true), .. } => {
                Err("`expect`: a hit has `t`, `point` and `normal`")
            }
            RawExpect { min_hits: Some(1), t: Some(t), .. } => Ok(Self::MeshHit { t }),
            RawExpect { min_hits: Some(_), .. } => Err("`expect`: `min_hits` is 1 and has a `t`"),
            RawExpect { .. } => Err("`expect` has `hit` or `min_hits`"),
        }
    }
}

impl From<Expect> for RawExpect {
    fn from(expect: Expect) -> Self {
        match expect {
            Expect::Miss => Self { hit: Some(false), ..Self::default() },
            Expect::Hit { t, point, normal } => Self {
                hit: Some(true),
                t: Some(t),
                point: Some(point),
                normal: Some(normal),
                ..Self::default()
            },
            Expect::MeshHit { t } => Self { min_hits: Some(1), t: Some(t), ..Self::default() },
        }
    }
}

/// Reads a file of cases. Empty lines and unknown fields are passed over.
///
/// # Errors
///
/// The first line that is no case, with its number and what was expected there.
pub fn read(source: impl BufRead) -> Result<Vec<HardCase>, ReadError> {
    json_lines::read(source)
}

/// Writes a file of cases.
///
/// # Errors
///
/// Those of `target`.
pub fn write(target: impl Write, cases: &[HardCase]) -> io::Result<()> {
    json_lines::write(target, cases)
}
