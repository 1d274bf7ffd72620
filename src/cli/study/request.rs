//! Request for a study.

use serde_json::{Value, json};

use crate::cli::session::impeller::scene;

/// Study of the demo's scene at one speed; the grid is the service's own.
pub(in crate::cli) fn default() -> Value {
    json!({
        "speeds": {"values": [24000], "unit": "rpm"},
        "scene": scene(),
        "integration": {"revolutions": 50, "ramp_revolutions": 1, "window_revolutions": 20},
    })
}
