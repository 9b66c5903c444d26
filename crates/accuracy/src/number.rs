//! Floating-point numbers in JSON: finite ones as the shortest decimal, NaN and infinities by name.
//!
//! `#[serde(with = "number")]` applies it to an `f32` or `f64`, and to arrays, lists and options of
//! them.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One number. A finite one is read as an `f64` and rounded; beyond `f32` it becomes infinite.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, \"NaN\", \"Infinity\" or \"-Infinity\"")]
pub(crate) enum Number<T> {
    Finite(T),
    Named(Name),
}

/// The names of the numbers that JSON lacks.
#[derive(Serialize, Deserialize)]
pub(crate) enum Name {
    NaN,
    Infinity,
    #[serde(rename = "-Infinity")]
    NegativeInfinity,
}

/// A number, or a collection of numbers, with its form in JSON.
pub(crate) trait Numbers {
    type Json: Serialize + DeserializeOwned;
    fn to_json(&self) -> Self::Json;
    fn from_json(json: Self::Json) -> Self;
}

macro_rules! numbers {
    ($($float:ident)*) => {$(
        impl Numbers for $float {
            type Json = Number<$float>;

            fn to_json(&self) -> Number<$float> {
                match *self {
                    finite if finite.is_finite() => Number::Finite(finite),
                    $float::INFINITY => Number::Named(Name::Infinity),
                    $float::NEG_INFINITY => Number::Named(Name::NegativeInfinity),
                    _ => Number::Named(Name::NaN),
                }
            }

            fn from_json(json: Number<$float>) -> $float {
                match json {
                    Number::Finite(finite) => finite,
                    Number::Named(Name::Infinity) => $float::INFINITY,
                    Number::Named(Name::NegativeInfinity) => $float::NEG_INFINITY,
                    Number::Named(Name::NaN) => $float::NAN,
                }
            }
        }
    )*};
}

numbers!(f32 f64);

impl<T: Numbers> Numbers for [T; 3] {
    type Json = [T::Json; 3];

    fn to_json(&self) -> Self::Json {
        self.each_ref().map(T::to_json)
    }

    fn from_json(json: Self::Json) -> Self {
        json.map(T::from_json)
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    type Json = Vec<T::Json>;

    fn to_json(&self) -> Self::Json {
        self.iter().map(T::to_json).collect()
    }

    fn from_json(json: Self::Json) -> Self {
        json.into_iter().map(T::from_json).collect()
    }
}

impl<T: Numbers> Numbers for Option<T> {
    type Json = Option<T::Json>;

    fn to_json(&self) -> Self::Json {
        self.as_ref().map(T::to_json)
    }

    fn from_json(json: Self::Json) -> Self {
        json.map(T::from_json)
    }
}

pub(crate) fn serialize<T: Numbers, S: Serializer>(
    numbers: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    numbers.to_json().serialize(serializer)
}

pub(crate) fn deserialize<'de, T: Numbers, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    T::Json::deserialize(deserializer).map(T::from_json)
}
