//! JSON of our own structures.

use serde::Serialize;
use serde_json::Value;

/// Returns indented JSON.
pub(crate) fn text(object: &impl Serialize) -> String {
    // It fails only for maps whose keys are not text, and there are no maps.
    serde_json::to_string_pretty(object).expect("plain structures are JSON")
}

/// Returns the same as a value whose keys keep their order.
pub(crate) fn value(object: &impl Serialize) -> Value {
    serde_json::to_value(object).expect("plain structures are JSON")
}
