//! What all JSON here has in common.

use rayweave_measure::Interval;
use serde::{Deserialize, Serialize};

/// Indented JSON of one of our own objects.
pub(crate) fn text(object: &impl Serialize) -> String {
    // It fails only for maps whose keys are not text, and there are no maps.
    serde_json::to_string_pretty(object).expect("plain structures are JSON")
}

/// A ratio with its interval.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Ratio {
    median: f64,
    low: f64,
    high: f64,
}

impl From<Interval> for Ratio {
    fn from(Interval { median, low, high }: Interval) -> Self {
        Self { median, low, high }
    }
}

impl From<Ratio> for Interval {
    fn from(Ratio { median, low, high }: Ratio) -> Self {
        Self { median, low, high }
    }
}
