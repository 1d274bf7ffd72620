//! Units by the ends of names. Documents and arrays have speeds in another unit beside every `…_rad_s`, as `…_rpm` or `…_hz`. Tables for
//! spreadsheets have every speed once, in rpm or the unit that is asked for, and motions in micrometres.

use serde_json::Value;

use super::array::{Array, Values};
use crate::analysis::request::SpeedUnit;

/// End of the names of speeds in rad/s.
const RAD_S: &str = "_rad_s";

/// End of the names of rates in rad/s².
const RAD_S2: &str = "_rad_s2";

/// Ends of the names of lengths, with micrometres per unit.
const LENGTHS: [(&str, f64); 2] = [("_mm", 1e3), ("_m", 1e6)];

/// Beginnings of the names of lengths that are no motion, and of energies.
const NO_MOTION: [&str; 6] = ["r_", "x_", "y_", "z_", "contact_length_", "energy_"];

/// Name of a column as engineers read it, and the factor of its values; `None` if it stays as it is.
pub(super) fn as_read(name: &str, unit: SpeedUnit) -> Option<(String, f64)> {
    if let Some(what) = name.strip_suffix(RAD_S2) {
        let (speed, factor) = converted(&format!("{what}{RAD_S}"), unit)?;
        return Some((format!("{speed}_s"), factor));
    }
    let is_motion = NO_MOTION.iter().all(|beginning| !name.starts_with(beginning));
    let motion = || {
        LENGTHS.iter().find_map(|(end, factor)| Some((format!("{}_um", name.strip_suffix(end)?), *factor)))
    };
    converted(name, unit).or_else(|| motion().filter(|_| is_motion))
}

/// Puts a table into the units in which engineers read it: speeds in `unit`, rpm without one, and motions in micrometres.
pub fn for_reading(mut table: Vec<Array>, unit: Option<SpeedUnit>) -> Vec<Array> {
    for column in table.iter_mut().filter(|column| !column.named_by_request) {
        if let Values::Real(values) = &mut column.values
            && let Some((name, factor)) = as_read(&column.name, unit.unwrap_or(SpeedUnit::Rpm))
        {
            column.name = name;
            values.iter_mut().for_each(|value| *value *= factor);
        }
    }
    table
}

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
            (Values::Real(values), Some((name, factor))) if !array.named_by_request => {
                let values = Values::Real(values.iter().map(|value| factor * value).collect());
                Some(Array { name, values, ..array.clone() })
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

    /// Parameters of a campaign: their names are the user's, and so are their units.
    #[test]
    fn names_that_the_request_gave_say_no_unit() {
        let given = vec![
            Array::reals("gap_mm", [0.25]).under_given_name(),
            Array::reals("whirl_rad_s", [3.0]).under_given_name(),
        ];
        assert_eq!(for_reading(given.clone(), None), given);
        assert_eq!(add_to_arrays(given.clone(), Some(SpeedUnit::Rpm)), given);
    }

    #[test]
    fn tables_are_in_the_units_of_engineers() {
        let turn_per_second = std::f64::consts::TAU;
        let table = |unit| {
            let reals = |name: &str, value: f64| Array::reals(name, [value]);
            let table = vec![
                reals("speed_rad_s", turn_per_second),
                reals("rate_rad_s2", turn_per_second),
                reals("rms_mm", 0.25),
                reals("order_0.5_m", 1e-6),
                reals("z_mm", 0.25),
                reals("contact_length_mm", 0.25),
                reals("energy_mechanical_N_mm", 0.25),
                reals("displacement_mm_or_strain", 0.25),
                reals("prominence_in", 0.25),
                reals("theta_rad", 0.25),
            ];
            let read = for_reading(table, unit).into_iter().map(|column| match column.values {
                Values::Real(values) => (column.name, values[0]),
                other => panic!("{other:?}"),
            });
            read.collect::<Vec<_>>()
        };
        let wanted = [
            ("speed_rpm", 60.0),
            ("rate_rpm_s", 60.0),
            ("rms_um", 250.0),
            ("order_0.5_um", 1.0),
            ("z_mm", 0.25),
            ("contact_length_mm", 0.25),
            ("energy_mechanical_N_mm", 0.25),
            ("displacement_mm_or_strain", 0.25),
            ("prominence_in", 0.25),
            ("theta_rad", 0.25),
        ];
        for ((name, value), (wanted_name, wanted)) in table(None).into_iter().zip(wanted) {
            assert_eq!(name, wanted_name);
            assert!((value - wanted).abs() < 1e-12 * wanted, "{name}: {value}");
        }
        assert_eq!(
            table(Some(SpeedUnit::RadS))[..2],
            [("speed_rad_s".to_owned(), turn_per_second), ("rate_rad_s2".to_owned(), turn_per_second)]
        );
    }
}
