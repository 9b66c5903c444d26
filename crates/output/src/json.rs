//! JSON from this workspace's structures.

use serde::Serialize;
use serde_json::Value;

/// Returns indented JSON.
pub(crate) fn text(object: &impl Serialize) -> String {
    // Only maps with keys that are not text can fail, and there are none.
    serde_json::to_string_pretty(object).expect("plain structures are JSON")
}

/// Returns a JSON value whose keys keep their order.
pub(crate) fn value(object: &impl Serialize) -> Value {
    serde_json::to_value(object).expect("plain structures are JSON")
}
