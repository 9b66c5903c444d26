//! Exact decimal numbers, in which the oracle writes its answers.

use std::fmt;
use std::str::FromStr;

use dashu_float::DBig;
use dashu_ratio::RBig;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The number of significant digits that the oracle writes.
pub const DIGITS: usize = 40;
/// The number of additional digits while a number is rounded.
const GUARD_DIGITS: usize = 25;
/// The length of the longest text that is accepted as a number, in bytes.
const LONGEST: usize = 200;
/// The largest accepted power of ten. Larger ones do not occur in answers to f32 cases, and would
/// exhaust memory.
const LARGEST_EXPONENT: isize = 1000;

/// An exact decimal number, such as `0.5` or `-1.25e-34`. Comparison is numeric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Decimal(DBig);

/// The error for a text that is not a decimal number, or one that is too long, large or small.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("expected a decimal number like \"0.5\" or \"-1.25e-34\", found {0:?}")]
pub struct NotDecimal(String);

impl Decimal {
    /// Rounds a number to [`DIGITS`] significant digits.
    pub(crate) fn rounded(number: &RBig) -> Self {
        // The rounding of the quotient, of a few units in the last place, must not reach the digits
        // that are kept.
        let longer: DBig = number.to_float(DIGITS + GUARD_DIGITS).value();
        Self(longer.with_precision(DIGITS).value())
    }

    /// Returns the number as a fraction, without rounding.
    #[must_use]
    pub fn exact(&self) -> RBig {
        // Only an infinite number is not a fraction. None is ever read or computed.
        RBig::try_from(self.0.clone()).unwrap_or_default()
    }

    /// Returns the nearest `f64`.
    #[must_use]
    pub fn to_f64(&self) -> f64 {
        self.exact().to_f64().value()
    }
}

impl FromStr for Decimal {
    type Err = NotDecimal;

    fn from_str(text: &str) -> Result<Self, NotDecimal> {
        let number = (text.len() <= LONGEST).then(|| DBig::from_str(text).ok()).flatten();
        match number {
            Some(number)
                if number.repr().is_finite()
                    && number.repr().exponent().abs() <= LARGEST_EXPONENT =>
            {
                Ok(Self(number))
            }
            _ => Err(NotDecimal(text.chars().take(LONGEST).collect())),
        }
    }
}

impl TryFrom<String> for Decimal {
    type Error = NotDecimal;

    fn try_from(text: String) -> Result<Self, NotDecimal> {
        text.parse()
    }
}

impl From<Decimal> for String {
    fn from(number: Decimal) -> Self {
        number.to_string()
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.to_f64().abs();
        if size == 0.0 || (1e-5..1e40).contains(&size) {
            write!(formatter, "{}", self.0)
        } else {
            write!(formatter, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_preserved() {
        for text in
            ["0", "4", "-0.5", "1.414213562373095048801688724209698078570", "1.25e-34", "-7e60"]
        {
            let number: Decimal = text.parse().expect(text);
            assert_eq!(number.to_string().parse(), Ok(number.clone()), "{text}");
        }
        assert_eq!("1.25e-34".parse::<Decimal>().expect("a number").to_string(), "1.25e-34");
        assert_eq!("0.50".parse::<Decimal>(), "0.5".parse());
        assert_eq!("-1.5".parse::<Decimal>().expect("a number").to_f64(), -1.5);
    }

    #[test]
    fn invalid_numbers_are_rejected() {
        for text in
            ["", "inf", "NaN", "1.2.3", "1e999999999999", "1e-2000", "zero", &"1".repeat(300)]
        {
            assert!(text.parse::<Decimal>().is_err(), "{text}");
        }
    }
}
