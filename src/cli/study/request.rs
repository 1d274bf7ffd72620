//! What a study asks for.

use std::path::Path;

use anyhow::{Context, bail};
use serde_json::{Value, json};

use crate::cli::session::impeller::scene;

/// The demo's scene at one speed; the grid is the service's own.
pub(in crate::cli) fn default() -> Value {
    json!({
        "speeds": {"values": [24000], "unit": "rpm"},
        "scene": scene(),
        "integration": {"revolutions": 50, "ramp_revolutions": 1, "window_revolutions": 20},
    })
}

/// The request of a file.
pub(super) fn read(path: &Path) -> anyhow::Result<Value> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let body: Value =
        serde_json::from_str(&text).with_context(|| format!("{} is not JSON", path.display()))?;
    if !body.is_object() {
        bail!("{} is not the body of POST /v1/studies, which is a JSON object", path.display());
    }
    Ok(body)
}

/// `body` with its model filled in.
///
/// # Errors
/// A body that names another model.
pub(super) fn of_model(mut body: Value, model: &str) -> anyhow::Result<Value> {
    match body.get("model") {
        Some(named) if named != model => {
            bail!(
                "the request is about model {named}, the package is model {model}: leave `model` out of the request"
            )
        }
        _ => body["model"] = json!(model),
    }
    Ok(body)
}
