//! Requests of the demo, as a user would write them.

use serde_json::{Value, json};

use crate::analysis::request::AutoOr;
use crate::cli::session::impeller::scene;

/// Revolutions of the window where a run ends by itself.
const WINDOW: u32 = 20;

/// Request for natural frequencies from standstill to beyond the sweep.
pub(super) fn modal_analysis(model: &str) -> Value {
    json!({
        "model": model,
        "modes_per_speed": 20,
        "families": 2,
        "superharmonics": [1, 2, 3],
        "lobes": 2,
        "speeds": {"from": 0, "to": 38000, "count": 39, "unit": "rpm"},
    })
}

/// Request for a sweep of the scene over the whole range of speeds.
pub(super) fn sweep(model: &str, speeds: u32, revolutions: AutoOr) -> Value {
    json!({
        "model": model,
        "modes_per_speed": 20,
        "speeds": {"from": 12000, "to": 36000, "count": speeds, "unit": "rpm"},
        "scene": scene(),
        "integration": integration(revolutions),
        "sensors": [
            {"contact_node": 0, "sector": 0, "component": "radial"},
            {"contact_node": 9, "sector": 0, "component": "radial"},
        ],
        "max_engine_order": 24,
    })
}

/// Settings by which every speed is integrated.
pub(super) fn integration(revolutions: AutoOr) -> Value {
    let window = match revolutions {
        AutoOr::Fixed(revolutions) => (2 * revolutions / 5).max(1),
        AutoOr::Auto => WINDOW,
    };
    json!({
        "steps_per_revolution": "auto",
        "revolutions": revolutions,
        "ramp_revolutions": 1,
        "window_revolutions": window,
    })
}
