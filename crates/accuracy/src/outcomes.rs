//! The answer of a kernel to a case, as a JSON object: `{"id": "...", "hit": true, "t": 1.5}`.

use serde::{Deserialize, Serialize};

use crate::number;

/// The answer of a kernel to one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The id of the case.
    pub id: String,
    /// True if the primitive was hit; for a mesh, if any triangle was.
    pub hit: bool,
    /// The distance of the hit in units of the direction; for a mesh that of the closest hit. It
    /// may be absent on a miss.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "number")]
    pub t: Option<f64>,
}
