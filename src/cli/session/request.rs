//! Requests that users write to a file.

use std::path::Path;

use anyhow::{Context, bail};
use serde_json::{Value, json};

/// The body of a POST to `route` that a file has.
pub(in crate::cli) fn read(path: &Path, route: &str) -> anyhow::Result<Value> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let body: Value =
        serde_json::from_str(&text).with_context(|| format!("{} is not JSON", path.display()))?;
    if !body.is_object() {
        bail!("{} is not the body of POST {route}, which is a JSON object", path.display());
    }
    Ok(body)
}

/// `body` with its model filled in.
///
/// # Errors
/// A body that names another model.
pub(in crate::cli) fn of_model(mut body: Value, model: &str) -> anyhow::Result<Value> {
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
