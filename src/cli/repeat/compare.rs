//! Comparison of two archives of the same request, bit by bit, except for what is a matter of time.

use std::collections::BTreeSet;

use serde_json::Value;

use super::archive::Archive;
use crate::http::archive::manifest::{RESULTS, SETTINGS};

/// Fields that are no results: times, what was made of them, and which program it was.
const NO_RESULTS: [&str; 9] = [
    "wall_time_s",
    "computing_time_s",
    "time_s",
    "cost",
    "pareto",
    "expected_wall_time_s",
    "plan",
    "spent",
    "version",
];

/// Differences that are shown at most of an entry.
const SHOWN: usize = 3;

/// Outcome of a comparison.
#[derive(Debug, Default)]
pub(super) struct Comparison {
    /// Number of results that are the same.
    pub(super) same: usize,
    /// Differences, result by result.
    pub(super) different: Vec<String>,
}

/// Compares the results of two archives.
pub(super) fn compare(archived: &Archive, repeated: &Archive) -> anyhow::Result<Comparison> {
    let results = |archive: &Archive| -> BTreeSet<String> {
        let names = archive.manifest.entries.iter().map(|entry| entry.name.clone());
        names.filter(|name| name.starts_with(RESULTS) || name == SETTINGS).collect()
    };
    let mut found = Comparison::default();
    for name in results(archived).union(&results(repeated)) {
        match (archived.entry(name), repeated.entry(name)) {
            (Some(before), Some(now)) if before.sha256 == now.sha256 => found.same += 1,
            (Some(_), Some(_)) => match differences(&archived.json(name)?, &repeated.json(name)?) {
                None => found.same += 1,
                Some(words) => found.different.push(format!("{name}: {words}")),
            },
            (Some(_), None) => found.different.push(format!("{name}: not computed this time")),
            (None, _) => found.different.push(format!("{name}: not in the archive")),
        }
    }
    Ok(found)
}

/// Differences of two results, in words; `None` where there are none.
fn differences(before: &Value, now: &Value) -> Option<String> {
    let mut found = Vec::new();
    walk(before, now, &mut String::new(), &mut found);
    let shown = found.iter().take(SHOWN).cloned().collect::<Vec<_>>().join("; ");
    match found.len() {
        0 => None,
        count if count > SHOWN => Some(format!("{shown}; and {} more", count - SHOWN)),
        _ => Some(shown),
    }
}

fn walk(before: &Value, now: &Value, pointer: &mut String, found: &mut Vec<String>) {
    let mut within = |step: &str, before: &Value, now: &Value| {
        let length = pointer.len();
        pointer.push('/');
        pointer.push_str(step);
        walk(before, now, pointer, found);
        pointer.truncate(length);
    };
    match (before, now) {
        (Value::Object(before), Value::Object(now)) => {
            let names: BTreeSet<&String> = before.keys().chain(now.keys()).collect();
            for name in names.into_iter().filter(|name| !NO_RESULTS.contains(&name.as_str())) {
                let value =
                    |object: &serde_json::Map<String, Value>| object.get(name).cloned().unwrap_or_default();
                within(name, &value(before), &value(now));
            }
        }
        (Value::Array(before), Value::Array(now)) if before.len() == now.len() => {
            for (index, (before, now)) in before.iter().zip(now).enumerate() {
                within(&index.to_string(), before, now);
            }
        }
        // Values are compared as they are written: 0 and -0 are equal numbers, but different bits.
        _ => {
            let (before, now) = (excerpt(before), excerpt(now));
            if before != now {
                found.push(format!("{pointer} was {before}, is {now}"));
            }
        }
    }
}

/// Text by which a value is shown: in full if it is a number.
fn excerpt(value: &Value) -> String {
    match value {
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(_) => "an object".to_owned(),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::differences;

    #[test]
    fn the_last_bit_is_a_difference_and_time_is_none() {
        let x = 0.1f64;
        let result = |value: f64, seconds: f64| json!({"points": [{"rms": value, "wall_time_s": seconds}], "version": "1"});
        assert_eq!(differences(&result(x, 1.0), &result(x, 2.0)), None);
        let next = f64::from_bits(x.to_bits() + 1);
        let words = differences(&result(x, 1.0), &result(next, 1.0)).unwrap();
        assert_eq!(words, "/points/0/rms was 0.1, is 0.10000000000000002");
        assert!(differences(&json!(0.0), &json!(-0.0)).is_some());
        assert!(differences(&json!([1]), &json!([1, 2])).unwrap().contains("a list of 2"));
        assert_eq!(differences(&json!({"a": 1}), &json!({})).unwrap(), "/a was 1, is null");
        let many = differences(&json!([1, 2, 3, 4, 5]), &json!([0, 0, 0, 0, 0])).unwrap();
        assert!(many.ends_with("and 2 more"), "{many}");
    }
}
