//! Speeds in another unit: beside every `…_rad_s` the same speed as `…_rpm` or `…_hz`.

use serde_json::Value;

use super::array::{Array, Values};
use crate::analysis::request::SpeedUnit;

/// End of the names of speeds in rad/s.
const RAD_S: &str = "_rad_s";

/// Name of `name` in `unit`, and number of these units in one rad/s; `None` if `name` is no speed, or is in that unit already.
pub(super) fn converted(name: &str, unit: SpeedUnit) -> Option<(String, f64)> {
    let suffix = match unit {
        SpeedUnit::RadS => return None,
        SpeedUnit::Rpm => "_rpm",
        SpeedUnit::Hz => "_hz",
    };
    Some((format!("{}{suffix}", name.strip_suffix(RAD_S)?), 1.0 / unit.rad_s()))
}

/// Adds to arrays their speeds in `unit`, each behind the array that it is made of.
pub fn add_to_arrays(arrays: Vec<Array>, unit: Option<SpeedUnit>) -> Vec<Array> {
    let Some(unit) = unit else { return arrays };
    let mut all = Vec::with_capacity(arrays.len() + 1);
    for array in arrays {
        let added = match (&array.values, converted(&array.name, unit)) {
            (Values::Real(values), Some((name, factor))) => {
                let values = values.iter().map(|value| factor * value).collect();
                Some(Array { name, shape: array.shape.clone(), values: Values::Real(values) })
            }
            _ => None,
        };
        all.push(array);
        all.extend(added);
    }
    all
}

/// Adds to a document its speeds in `unit`.
pub fn add_to_json(document: &mut Value, unit: SpeedUnit) {
    match document {
        Value::Array(items) => items.iter_mut().for_each(|item| add_to_json(item, unit)),
        Value::Object(fields) => {
            fields.values_mut().for_each(|field| add_to_json(field, unit));
            let added: Vec<(String, Value)> = fields
                .iter()
                .filter_map(|(name, value)| {
                    let (name, factor) = converted(name, unit)?;
                    Some((name, times(value, factor)?))
                })
                .collect();
            fields.extend(added);
        }
        _ => {}
    }
}

fn times(value: &Value, factor: f64) -> Option<Value> {
    match value {
        Value::Array(items) => {
            items.iter().map(|item| times(item, factor)).collect::<Option<_>>().map(Value::Array)
        }
        value => value.as_f64().map(|number| Value::from(factor * number)),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_is_in_rad_s_is_there_in_rpm_as_well() {
        let turn_per_second = std::f64::consts::TAU;
        let mut document = json!({
            "speeds_rad_s": [0.0, turn_per_second],
            "points": [{"speed_rad_s": turn_per_second, "steps": 3}],
            "distance_rad_s": null,
            "settings": {"speeds": {"values": [1.0], "unit": "rad_s"}},
        });
        add_to_json(&mut document, SpeedUnit::Rpm);
        assert_eq!(document["speeds_rpm"], json!([0.0, 60.0]));
        assert_eq!(document["points"][0]["speed_rpm"], json!(60.0));
        assert_eq!(document["settings"], json!({"speeds": {"values": [1.0], "unit": "rad_s"}}));
        assert!(document.get("distance_rpm").is_none());
        let arrays = vec![Array::reals("speeds_rad_s", [turn_per_second]), Array::reals("rms_mm", [1.0])];
        let arrays = add_to_arrays(arrays, Some(SpeedUnit::Hz));
        let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
        assert_eq!(names, ["speeds_rad_s", "speeds_hz", "rms_mm"]);
        assert_eq!(arrays[1].values, Values::Real(vec![1.0]));
    }
}
