//! f32 numbers in JSON: finite ones as the shortest decimal, the others as strings.

use std::fmt;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One number of an input. Read as an f64, rounded to f32; beyond f32 it becomes infinite.
#[derive(Clone, Copy)]
struct Number(f32);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            finite if finite.is_finite() => serializer.serialize_f32(finite),
            nan if nan.is_nan() => serializer.serialize_str("NaN"),
            infinite if infinite > 0.0 => serializer.serialize_str("Infinity"),
            _ => serializer.serialize_str("-Infinity"),
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberVisitor)
    }
}

struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = Number;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a number, \"NaN\", \"Infinity\" or \"-Infinity\"")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Number, E> {
        Ok(Number(value as f32))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Number, E> {
        Ok(Number(value as f64 as f32))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Number, E> {
        Ok(Number(value as f64 as f32))
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<Number, E> {
        match value {
            "NaN" => Ok(Number(f32::NAN)),
            "Infinity" => Ok(Number(f32::INFINITY)),
            "-Infinity" => Ok(Number(f32::NEG_INFINITY)),
            other => Err(E::invalid_value(de::Unexpected::Str(other), &self)),
        }
    }
}

/// `#[serde(with = "number::scalar")]` for an `f32`.
pub(super) mod scalar {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(value: &f32, serializer: S) -> Result<S::Ok, S::Error> {
        Number(*value).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
        Number::deserialize(deserializer).map(|number| number.0)
    }
}

/// `#[serde(with = "number::vector")]` for a `[f32; 3]`.
pub(super) mod vector {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(
        value: &[f32; 3],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        value.map(Number).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[f32; 3], D::Error> {
        <[Number; 3]>::deserialize(deserializer).map(|numbers| numbers.map(|number| number.0))
    }
}

/// `#[serde(with = "number::triangles")]` for triangles as lists of three vertices.
pub(super) mod triangles {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(
        value: &[[[f32; 3]; 3]],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer
            .collect_seq(value.iter().map(|triangle| triangle.map(|vertex| vertex.map(Number))))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<[[f32; 3]; 3]>, D::Error> {
        let triangles = Vec::<[[Number; 3]; 3]>::deserialize(deserializer)?;
        Ok(triangles
            .into_iter()
            .map(|triangle| triangle.map(|vertex| vertex.map(|number| number.0)))
            .collect())
    }
}
