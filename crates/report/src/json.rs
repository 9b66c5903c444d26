//! What all JSON here has in common.

use serde::Serialize;

/// Indented JSON of one of our own objects.
pub(crate) fn text(object: &impl Serialize) -> String {
    // It fails only for maps whose keys are not text, and there are no maps.
    serde_json::to_string_pretty(object).expect("plain structures are JSON")
}
