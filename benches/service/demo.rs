//! Sweep of the demo for benchmarks.

use serde_json::{Value, json};

/// Request for a sweep of the demo's impeller over so many speeds, with one sensor.
pub(crate) fn demo_sweep(model: &Value, speeds: u32, revolutions: &Value) -> Value {
    json!({
        "model": model,
        "modes_per_speed": 20,
        "speeds": {"from": 12000, "to": 36000, "count": speeds, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.3, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": revolutions, "ramp_revolutions": 1, "window_revolutions": 20},
        "sensors": [{"contact_node": 0, "sector": 0, "component": "radial"}],
        "max_engine_order": 24,
    })
}
