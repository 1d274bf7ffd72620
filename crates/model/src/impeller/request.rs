//! Parameter set as users write it: a preset's name and the fields that differ from it.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::error::{FieldProblem, ImpellerError};
use super::parameters::ImpellerParameters;
use super::preset::Preset;
use crate::package::quote::{bounded_message, quoted};
use rubmap_wheel::dynamics::sector::Units;

/// Request such as `{"preset": "paper", "sectors": 13, "mesh": {"disk": 6}}`: fields of [`ImpellerParameters`] beside the name of the
/// preset that gives all others. Without a name: `small`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ImpellerRequest {
    /// Preset from which all parameters come that are not given.
    #[serde(default)]
    pub preset: Preset,
    /// Fields that are given: objects in objects field by field, but `units` as a whole, to which the preset is then converted.
    #[serde(flatten)]
    pub overrides: Map<String, Value>,
}

impl ImpellerRequest {
    /// Parameters of the preset with the given ones in their place, all in their ranges.
    ///
    /// # Errors
    /// [`ImpellerError::Field`] for a field that is unknown, missing or of the wrong type, [`ImpellerError::Parameter`] for one out of
    /// range.
    pub fn resolve(&self) -> Result<ImpellerParameters, ImpellerError> {
        let refuse = |field: String, message: String| {
            let problem = FieldProblem::Syntax { message: bounded_message(&message) };
            Err(ImpellerError::Field { field: quoted(&field), problem })
        };
        let mut preset = self.preset.parameters();
        // Units that are none are refused below.
        if let Some(units) = self.overrides.get("units").and_then(|units| Units::deserialize(units).ok()) {
            preset = match preset.in_units(&units) {
                Ok(preset) => preset,
                Err(field) => {
                    let words =
                        "unknown unit: presets cannot be told in it; take one such as m, N, kg or mm, N, t";
                    return refuse(field.to_owned(), words.to_owned());
                }
            };
        }
        let mut merged = match serde_json::to_value(preset) {
            Ok(value) => value,
            Err(error) => return refuse("preset".to_owned(), error.to_string()),
        };
        for (key, value) in &self.overrides {
            // Units fit each other only as a whole.
            if key == "units" {
                merged[key] = Value::Null;
            }
            merge(&mut merged[key], value, key)?;
        }
        match serde_path_to_error::deserialize::<_, ImpellerParameters>(merged) {
            Ok(parameters) => parameters.validate().map(|()| parameters),
            Err(error) => refuse(error.path().to_string(), error.inner().to_string()),
        }
    }
}

/// Replaces `value` by `given`; an object replaces another one field by field.
fn merge(value: &mut Value, given: &Value, path: &str) -> Result<(), ImpellerError> {
    match (value, given) {
        (Value::Object(fields), Value::Object(given)) => given.iter().try_for_each(|(key, given)| {
            merge(fields.entry(key.as_str()).or_insert(Value::Null), given, &format!("{path}.{key}"))
        }),
        // No field is a list, but serde would take one for an object with its fields in order.
        (_, Value::Array(_)) => {
            Err(ImpellerError::Field { field: quoted(path), problem: FieldProblem::List })
        }
        (value, given) => {
            *value = given.clone();
            Ok(())
        }
    }
}
