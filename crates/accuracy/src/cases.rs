//! The format of hard cases: one ray, one primitive and the exact answer, as a JSON object.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::decimal::Decimal;
use crate::number;

/// One ray against one primitive.
///
/// Every number of `primitive` and `ray` is an f32; a kernel in f64 widens it. Equality follows
/// IEEE 754, so a case that contains a NaN differs from itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HardCase {
    /// The name of its family: see [`crate::families`].
    pub family: String,
    /// Its id, unique in a file.
    pub id: String,
    /// The target of the ray.
    pub primitive: Primitive,
    /// The ray.
    pub ray: Ray,
    /// The exact answer; `None` if it has not been computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<Expect>,
    /// True if a good f32 kernel must get the verdict right: see [`crate::oracle`].
    #[serde(default)]
    pub decidable: bool,
    /// The relative condition number of `t`, 0 on a miss, 9.9e99 for infinite.
    #[serde(default)]
    pub cond: f64,
    /// The distance to the closest other verdict in f32 ulps of the inputs, 9.9e99 for infinite.
    #[serde(default)]
    pub margin: f64,
    /// A description of the difficulty, for human readers.
    #[serde(default)]
    pub note: String,
}

/// A ray, `origin + t direction`; the direction may have any length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ray {
    /// The start of the ray.
    #[serde(with = "number")]
    pub origin: [f32; 3],
    /// The direction; `t` is in units of it.
    #[serde(with = "number")]
    pub direction: [f32; 3],
}

/// Converts a vector to double precision.
pub(crate) fn double(vector: [f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}

/// A primitive that a ray is tested against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Primitive {
    /// An infinite plane.
    Plane {
        /// Any point of the plane.
        #[serde(with = "number")]
        point: [f32; 3],
        /// The normal, of any length.
        #[serde(with = "number")]
        normal: [f32; 3],
    },
    /// A sphere.
    Sphere {
        /// The centre.
        #[serde(with = "number")]
        center: [f32; 3],
        /// The radius.
        #[serde(with = "number")]
        radius: f32,
    },
    /// A triangle with its edges and vertices.
    Triangle {
        /// The first vertex.
        #[serde(with = "number")]
        a: [f32; 3],
        /// The second vertex.
        #[serde(with = "number")]
        b: [f32; 3],
        /// The third vertex.
        #[serde(with = "number")]
        c: [f32; 3],
    },
    /// The wall of a cylinder around a vertical axis, with its rims and without caps.
    Cylinder {
        /// The lower end of the axis.
        #[serde(with = "number")]
        bottom: [f32; 3],
        /// The upper end: `bottom` with a greater y.
        #[serde(with = "number")]
        top: [f32; 3],
        /// The radius.
        #[serde(with = "number")]
        radius: f32,
    },
    /// Triangles that share edges and vertices; the closest hit of all counts.
    Mesh {
        /// The three vertices of each triangle.
        #[serde(with = "number")]
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
        /// The distance along the ray, in units of its direction.
        t: Decimal,
        /// The point of the hit.
        point: Box<[Decimal; 3]>,
        /// The unit normal, not turned towards the ray: as given for a plane, outward for a sphere
        /// or cylinder, along `(b - a) x (c - a)` for a triangle.
        normal: Box<[Decimal; 3]>,
    },
    /// At least one triangle of the mesh is hit.
    MeshHit {
        /// The distance of the closest hit.
        t: Decimal,
    },
}

impl Expect {
    /// Returns whether anything is hit.
    #[must_use]
    pub fn is_hit(&self) -> bool {
        !matches!(self, Self::Miss)
    }

    /// Returns the distance of a hit.
    #[must_use]
    pub fn t(&self) -> Option<&Decimal> {
        match self {
            Self::Miss => None,
            Self::Hit { t, .. } | Self::MeshHit { t } => Some(t),
        }
    }
}

/// The form of [`Expect`] in JSON.
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
