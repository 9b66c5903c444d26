//! The errors of a scene that breaks a rule, and the checks that several rules share.

use glam::DVec3;
use std::fmt;
use thiserror::Error;

/// A value in a scene that breaks a rule: its key, what was expected, what was found.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("`{key}` must be {expected}, but is {found}")]
pub struct SceneFault {
    /// The key of the value, as a scene file spells it: `radius`.
    pub key: &'static str,
    /// The values that are allowed: `a number above 0`.
    pub expected: &'static str,
    /// The value that is there: `-1`.
    pub found: String,
}

/// A [`SceneFault`] and the entry it belongs to.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{entry}: {fault}")]
pub struct SceneError {
    /// The entry, counted from 0 within its list: `sphere[2]`.
    pub entry: String,
    /// The rule that it breaks.
    pub fault: SceneFault,
}

/// Checks each entry of the list called `kind`.
pub(crate) fn check_all<T>(
    kind: &str,
    entries: &[T],
    check: impl Fn(&T) -> Result<(), SceneFault>,
) -> Result<(), SceneError> {
    entries
        .iter()
        .enumerate()
        .try_for_each(|(i, entry)| locate(format!("{kind}[{i}]"), check(entry)))
}

/// Adds the entry to a fault.
pub(crate) fn locate(
    entry: impl Into<String>,
    result: Result<(), SceneFault>,
) -> Result<(), SceneError> {
    result.map_err(|fault| SceneError { entry: entry.into(), fault })
}

/// Makes a fault unless the rule `holds`.
pub(crate) fn expect(
    key: &'static str,
    holds: bool,
    expected: &'static str,
    found: impl fmt::Display,
) -> Result<(), SceneFault> {
    if holds { Ok(()) } else { Err(SceneFault { key, expected, found: found.to_string() }) }
}

/// Checks that `v` has no infinity and no NaN.
pub(crate) fn finite(key: &'static str, v: DVec3) -> Result<(), SceneFault> {
    expect(key, v.is_finite(), "finite numbers", v)
}

/// Checks that `x` is finite and above 0.
pub(crate) fn positive(key: &'static str, x: f64) -> Result<(), SceneFault> {
    expect(key, x.is_finite() && x > 0.0, "a finite number above 0", x)
}

/// Checks that `x` is finite and 0 or more.
pub(crate) fn not_negative(key: &'static str, x: f64) -> Result<(), SceneFault> {
    expect(key, x.is_finite() && x >= 0.0, "a finite number of 0 or more", x)
}

/// Checks that each channel of `c` is in 0..=1.
pub(crate) fn color(key: &'static str, c: DVec3) -> Result<(), SceneFault> {
    let shares = c.to_array().iter().all(|share| (0.0..=1.0).contains(share));
    expect(key, shares, "three numbers in 0..=1", c)
}
