//! Requests of the demo, as a user would write them.

use serde_json::{Value, json};

use crate::analysis::request::AutoOr;

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
        "speeds": {"from": 0, "to": 30000, "count": 31, "unit": "rpm"},
    })
}

/// Casing whose lobes reach 0.02 mm inside the trailing edges: at most speeds the tips but graze it.
fn scene() -> Value {
    json!({
        "centrifugal_stiffening": true,
        "damping": {"modal_ratio": 0.005},
        "casing": {
            "clearance": {"leading": 0.30, "trailing": 0.22},
            "lobes": {"count": 2, "amplitude": 0.24, "width_rad": 0.35},
        },
        "contact": {},
    })
}

/// Request for a sweep of the scene over the whole range of speeds, judged by two ranges of operation.
pub(super) fn sweep(model: &str, speeds: u32, revolutions: AutoOr) -> Value {
    json!({
        "model": model,
        "modes_per_speed": 20,
        "speeds": {"from": 12000, "to": 28000, "count": speeds, "unit": "rpm"},
        "scene": scene(),
        "integration": integration(revolutions),
        "max_engine_order": 24,
        "operation": {"ranges": [
            {"name": "part load", "from": 13200, "to": 13900, "unit": "rpm", "separation_percent": 2},
            {"name": "full load", "from": 20500, "to": 24000, "unit": "rpm", "separation_percent": 2},
        ]},
        "limits": {"clearance_consumption": 0.9, "utilisation": 0.8},
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
