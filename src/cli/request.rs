//! Requests that users write to a file.

use std::io::Read;
use std::path::Path;

use anyhow::{Context, bail};
use serde_json::{Value, json};

/// Name that stands for the input stream.
const STDIN: &str = "-";

/// Reads the body of a POST to `route` from a file in JSON or YAML.
///
/// # Errors
/// A file that cannot be read, or has something else in it; line and column are reported.
pub(super) fn read(path: &Path, route: &str) -> anyhow::Result<Value> {
    let (name, text) = if path == Path::new(STDIN) {
        let mut text = String::new();
        std::io::stdin().read_to_string(&mut text).context("cannot read the input")?;
        ("the input".to_owned(), text)
    } else {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
        (name, text)
    };
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    // YAML reads JSON, too, but speaks of it in words of its own.
    let is_json =
        ending == "json" || (text.trim_start().starts_with('{') && !["yaml", "yml"].contains(&ending));
    let body: Value = if is_json {
        serde_json::from_str(&text).with_context(|| format!("{name} is not JSON"))?
    } else {
        from_yaml(&text).with_context(|| format!("{name} is not YAML"))?
    };
    if !body.is_object() {
        bail!("{name} is not the body of POST {route}, which is an object");
    }
    Ok(body)
}

/// Reads YAML by way of YAML's own values, which refuse keys that are given twice.
fn from_yaml(text: &str) -> anyhow::Result<Value> {
    let value: yaml_serde::Value = yaml_serde::from_str(text)?;
    Ok(serde_json::to_value(value)?)
}

/// Request `body` with its model filled in.
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

/// Change of a field of a request: `/speeds/count=80`.
#[derive(Debug, Clone)]
pub(super) struct Setting {
    /// Names and indices on the way to the field.
    path: Vec<String>,
    value: Value,
}

impl Setting {
    /// Reads an RFC 6901 pointer and a value in JSON or YAML.
    ///
    /// # Errors
    /// A message for a text that has no pointer or no value.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let (pointer, value) = text.split_once('=').ok_or("a setting is like /speeds/count=80")?;
        let path =
            pointer.strip_prefix('/').ok_or("the field is an RFC 6901 pointer, such as /speeds/count")?;
        let path = path.split('/').map(|name| name.replace("~1", "/").replace("~0", "~")).collect();
        let value = from_yaml(value).map_err(|error| format!("{value} is no value: {error}"))?;
        Ok(Self { path, value })
    }

    /// Changes a body. Missing objects on the way are made; a list must have the entry already.
    ///
    /// # Errors
    /// A way through a value that has no fields.
    pub(super) fn apply(&self, body: &mut Value) -> anyhow::Result<()> {
        let mut place = body;
        for (depth, name) in self.path.iter().enumerate() {
            if place.is_null() {
                *place = json!({});
            }
            let next = match place {
                Value::Object(fields) => Some(fields.entry(name.as_str()).or_insert(Value::Null)),
                Value::Array(entries) => name.parse().ok().and_then(|index: usize| entries.get_mut(index)),
                _ => None,
            };
            let pointer = self.path[..=depth].join("/");
            place = next.with_context(|| format!("the request has no place for /{pointer}"))?;
        }
        *place = self.value.clone();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(settings: &[&str]) -> anyhow::Result<Value> {
        let mut body = json!({"speeds": [{"count": 3}], "a/b": 1, "scene": null});
        for setting in settings {
            Setting::parse(setting).map_err(anyhow::Error::msg)?.apply(&mut body)?;
        }
        Ok(body)
    }

    #[test]
    fn settings_change_add_and_are_read_as_yaml() {
        let body =
            with(&["/speeds/0/count=80", "/a~1b=auto", "/scene/contact={}", "/name=x=1", "/list=[1, 2e3]"])
                .unwrap();
        let changed = json!({
            "speeds": [{"count": 80}], "a/b": "auto", "scene": {"contact": {}}, "name": "x=1", "list": [1, 2e3],
        });
        assert_eq!(body, changed);
    }

    #[test]
    fn settings_that_lead_nowhere_are_refused() {
        for (setting, words) in [
            ("count=1", "RFC 6901"),
            ("/count", "a setting is like"),
            ("/x={", "is no value"),
            ("/speeds/1/count=1", "/speeds/1"),
            ("/a~1b/c=1", "no place"),
        ] {
            let error = with(&[setting]).unwrap_err().to_string();
            assert!(error.contains(words), "{setting}: {error}");
        }
    }

    #[test]
    fn yaml_is_the_same_as_json() {
        let yaml = "# a sweep\nspeeds: {from: 1.5e3, to: 3000, count: 4, unit: rpm}\nscene:\n  contact: {}\nsteps: auto\non: yes\n";
        let same = json!({
            "speeds": {"from": 1.5e3, "to": 3000, "count": 4, "unit": "rpm"}, "scene": {"contact": {}},
            "steps": "auto", "on": "yes",
        });
        assert_eq!(from_yaml(yaml).unwrap(), same);
        let twice = from_yaml("a: 1\nb: 2\na: 3\n").unwrap_err().to_string();
        assert!(twice.contains("duplicate"), "{twice}");
        let broken = from_yaml("a: 1\nb: [2\nc: 3\n").unwrap_err().to_string();
        assert!(broken.contains("line"), "{broken}");
    }
}
