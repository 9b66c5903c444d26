//! What a kernel answered: a JSON object a line, `{"id": "...", "hit": true, "t": 1.5}`.

use std::io::{self, BufRead, Write};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::json_lines::{self, ReadError};

/// A kernel's answer to one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The case's id.
    pub id: String,
    /// Whether the primitive was hit; for a mesh, whether any triangle was.
    pub hit: bool,
    /// Where on the ray, in units of its direction; for a mesh the nearest. May be absent on a
    /// miss.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "serialize_t",
        deserialize_with = "deserialize_t"
    )]
    pub t: Option<f64>,
}

/// A number, or the name of one that JSON lacks.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "`t` is a number, \"NaN\", \"Infinity\", \"-Infinity\" or null")]
enum RawNumber {
    Number(f64),
    Named(Named),
}

#[derive(Serialize, Deserialize)]
enum Named {
    #[serde(rename = "NaN")]
    Nan,
    Infinity,
    #[serde(rename = "-Infinity")]
    NegativeInfinity,
}

fn serialize_t<S: Serializer>(t: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    t.map(|t| match t {
        finite if finite.is_finite() => RawNumber::Number(finite),
        nan if nan.is_nan() => RawNumber::Named(Named::Nan),
        infinite if infinite > 0.0 => RawNumber::Named(Named::Infinity),
        _ => RawNumber::Named(Named::NegativeInfinity),
    })
    .serialize(serializer)
}

fn deserialize_t<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Ok(Option::<RawNumber>::deserialize(deserializer)?.map(|number| match number {
        RawNumber::Number(number) => number,
        RawNumber::Named(Named::Nan) => f64::NAN,
        RawNumber::Named(Named::Infinity) => f64::INFINITY,
        RawNumber::Named(Named::NegativeInfinity) => f64::NEG_INFINITY,
    }))
}

/// Reads a file of outcomes. Empty lines and unknown fields are passed over.
///
/// # Errors
///
/// The first line that is no outcome, with its number and what was expected there.
pub fn read(source: impl BufRead) -> Result<Vec<Outcome>, ReadError> {
    json_lines::read(source)
}

/// Writes a file of outcomes.
///
/// # Errors
///
/// Those of `target`.
pub fn write(target: impl Write, outcomes: &[Outcome]) -> io::Result<()> {
    json_lines::write(target, outcomes)
}
