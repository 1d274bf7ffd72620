//! Rotational speeds as a user gives them: a range, a list, or several of them, such as refinement windows.

use std::collections::BTreeSet;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess};
use serde::{Deserialize, Deserializer, Serialize};

use crate::error::Violation;

/// Rotational speeds: one range or list, or an array of them, whose union in the order given is taken. Each range or list is taken as it is; a speed
/// that an earlier one has already (to 1e-9) is not computed again.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(untagged)]
pub enum Speeds {
    /// One range or list.
    One(SpeedSet),
    /// Several ranges or lists.
    Several(Vec<SpeedSet>),
}

/// Rotational speeds: evenly spaced `from`–`to` with `count`, or a list of `values`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct SpeedSet {
    /// First speed of the range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last speed of the range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Number of speeds in the range, both ends included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub count: Option<u32>,
    /// Explicit speeds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 10_000))]
    pub values: Option<Vec<f64>>,
    /// Unit of the numbers above.
    pub unit: SpeedUnit,
}

/// Unit of a rotational speed on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SpeedUnit {
    /// Radians per second.
    RadS,
    /// Revolutions per minute.
    Rpm,
    /// Revolutions per second.
    Hz,
}

impl SpeedUnit {
    /// Factor from this unit to rad/s.
    pub fn rad_s(self) -> f64 {
        use std::f64::consts::TAU;
        match self {
            Self::RadS => 1.0,
            Self::Rpm => TAU / 60.0,
            Self::Hz => TAU,
        }
    }
}

/// Highest speed, rad/s: larger numbers are typing errors.
pub const HIGHEST_SPEED: f64 = 1e7;

/// Lowest speed other than 0, rad/s: smaller numbers are typing errors, for a revolution would take more than two months.
pub const LOWEST_SPEED: f64 = 1e-6;

/// Largest number of speeds in one job.
pub const MAX_SPEEDS: usize = 10_000;

/// Relative difference up to which speeds of two ranges are one.
const SAME: f64 = 1e-9;

// By hand, so that errors keep their path: an untagged enum only says that nothing matched.
impl<'de> Deserialize<'de> for Speeds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = Speeds;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a range or list of speeds, or an array of them")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                SpeedSet::deserialize(MapAccessDeserializer::new(map)).map(Speeds::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Speeds::Several)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

impl Speeds {
    /// Number of speeds that may still be added.
    pub(crate) fn room(&self) -> usize {
        let sets = match self {
            Self::One(set) => std::slice::from_ref(set),
            Self::Several(sets) => sets,
        };
        let given = |set: &SpeedSet| set.values.as_ref().map_or(set.count.unwrap_or(0) as usize, Vec::len);
        MAX_SPEEDS.saturating_sub(sets.iter().map(given).sum())
    }

    /// Finds speeds that can be computed and cannot be meant. Apart from the other checks, for jobs of earlier versions have such speeds.
    pub(crate) fn implausible(&self) -> Vec<Violation> {
        match self {
            Self::One(set) => set.implausible("/speeds").into_iter().collect(),
            Self::Several(sets) => {
                let sets = sets.iter().enumerate();
                sets.filter_map(|(index, set)| set.implausible(&format!("/speeds/{index}"))).collect()
            }
        }
    }

    /// Speeds in rad/s, range by range in the order given: those of each range that no earlier one has.
    pub(crate) fn parts(&self) -> Result<Vec<Vec<f64>>, Vec<Violation>> {
        let sets = match self {
            Self::One(set) => {
                return Ok(vec![set.part("/speeds", MAX_SPEEDS).map_err(|v| vec![v])?]);
            }
            Self::Several(sets) if sets.is_empty() => {
                return Err(vec![Violation::new("/speeds", "at least one speed is needed")]);
            }
            Self::Several(sets) => sets,
        };
        let (mut parts, mut violations) = (Vec::new(), Vec::new());
        let mut room = MAX_SPEEDS;
        // As bits, which ascend as the numbers do where none is negative.
        let mut earlier = BTreeSet::new();
        for (index, set) in sets.iter().enumerate() {
            let mut part = match set.part(&format!("/speeds/{index}"), room) {
                Ok(part) => part,
                Err(violation) => {
                    violations.push(violation);
                    continue;
                }
            };
            room -= part.len();
            let near = |speed: f64| (speed * (1.0 - SAME)).to_bits()..=(speed * (1.0 + SAME)).to_bits();
            part.retain(|&speed| earlier.range(near(speed)).next().is_none());
            earlier.extend(part.iter().map(|speed| speed.to_bits()));
            parts.push(part);
        }
        if violations.is_empty() { Ok(parts) } else { Err(violations) }
    }
}

impl SpeedSet {
    fn implausible(&self, pointer: &str) -> Option<Violation> {
        if let (Some(from), Some(to), Some(count @ 2..)) = (self.from, self.to, self.count) {
            let apart = (to - from).abs() / f64::from(count - 1);
            if apart <= SAME * from.abs().max(to.abs()) {
                let message =
                    "its speeds are one and the same (to 1e-9): give a smaller count, or another end";
                return Some(Violation::new(format!("{pointer}/count"), message));
            }
        }
        let listed = self.values.iter().flatten().enumerate();
        let listed = listed.map(|(index, value)| (format!("{pointer}/values/{index}"), *value));
        let ends = [("from", self.from), ("to", self.to)];
        let ends = ends.into_iter().filter_map(|(end, value)| Some((format!("{pointer}/{end}"), value?)));
        let slow = |value: f64| value > 0.0 && value * self.unit.rad_s() < LOWEST_SPEED;
        let (field, value) = listed.chain(ends).find(|(_, value)| slow(*value))?;
        let message = format!("a speed is 0 or at least {LOWEST_SPEED:e} rad/s, unlike {value}");
        Some(Violation::new(field, message))
    }

    /// Speeds of the set in rad/s, of which there may be `room`.
    fn part(&self, pointer: &str, room: usize) -> Result<Vec<f64>, Violation> {
        let at = |field: &str, message: &str| Err(Violation::new(format!("{pointer}{field}"), message));
        let too_many = format!("at most {MAX_SPEEDS} speeds in one job, all ranges and lists together");
        let given = match (&self.values, self.from, self.to, self.count) {
            (Some(values), None, None, None) => values.clone(),
            (None, Some(from), Some(to), Some(count)) => match count {
                0 => return at("/count", "at least one speed is needed"),
                1 if from != to => {
                    return at("/count", "one speed cannot span from and to; give count ≥ 2");
                }
                _ if count as usize > room => return at("/count", &too_many),
                1 => vec![from],
                _ => {
                    let last = f64::from(count - 1);
                    (0..count).map(|i| from + (to - from) * (f64::from(i) / last)).collect()
                }
            },
            _ => return at("", "give either `from`, `to` and `count`, or `values`"),
        };
        if given.is_empty() {
            return at("/values", "at least one speed is needed");
        }
        if given.len() > room {
            return at("/values", &too_many);
        }
        // Adding 0 makes −0 a 0.
        let speeds_rad_s: Vec<f64> = given.iter().map(|v| v * self.unit.rad_s() + 0.0).collect();
        match speeds_rad_s.iter().position(|speed| !(0.0..=HIGHEST_SPEED).contains(speed)) {
            Some(bad) => {
                let field = if self.values.is_some() { format!("/values/{bad}") } else { String::new() };
                let message =
                    format!("a speed lies between 0 and {HIGHEST_SPEED:e} rad/s, unlike {}", given[bad]);
                at(&field, &message)
            }
            None => Ok(speeds_rad_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn speeds(given: Value) -> Speeds {
        serde_json::from_value(given).unwrap()
    }

    /// Speeds in rad/s, in the order given.
    fn resolve(speeds: &Speeds) -> Result<Vec<f64>, Vec<Violation>> {
        Ok(speeds.parts()?.concat())
    }

    fn pointers(given: Value) -> Vec<String> {
        resolve(&speeds(given)).unwrap_err().into_iter().map(|violation| violation.pointer).collect()
    }

    #[test]
    fn windows_are_joined_in_the_order_given_and_share_their_ends() {
        let given = json!([
            {"from": 100, "to": 200, "count": 3, "unit": "rad_s"},
            // 200 rad/s, an end point of both, in other words.
            {"from": 200.0 * 60.0 / std::f64::consts::TAU, "to": 300.0 * 60.0 / std::f64::consts::TAU, "count": 2, "unit": "rpm"},
            {"values": [120, 150, 120, 0], "unit": "rad_s"},
        ]);
        let joined = speeds(given.clone());
        let expected = [100.0, 150.0, 200.0, 300.0, 120.0, 120.0, 0.0];
        for (speed, expected) in resolve(&joined).unwrap().iter().zip(expected) {
            assert!((speed - expected).abs() < 1e-10, "{speed} {expected}");
        }
        assert_eq!(resolve(&joined).unwrap().len(), expected.len());
        // A list by itself is what it says: equal speeds are computed twice.
        assert_eq!(resolve(&speeds(json!({"values": [5, 5], "unit": "hz"}))).unwrap().len(), 2);
        // On the wire it stays as it was given.
        assert_eq!(speeds(serde_json::to_value(&joined).unwrap()), joined);
        assert!(serde_json::to_value(&joined).unwrap().is_array());
    }

    #[test]
    fn what_cannot_be_meant_is_found_apart() {
        let found = |given: Value| {
            let speeds = speeds(given);
            assert!(resolve(&speeds).is_ok(), "a job of an earlier version may have it");
            speeds.implausible().into_iter().map(|violation| violation.pointer).collect::<Vec<_>>()
        };
        assert_eq!(found(json!({"values": [0, 1e-300], "unit": "rpm"})), ["/speeds/values/1"]);
        let range =
            |from: f64, to: f64, count: u32| json!({"from": from, "to": to, "count": count, "unit": "hz"});
        assert_eq!(found(json!([range(1.0, 7.0, 3), range(7.0, 7.0, 3)])), ["/speeds/1/count"]);
        assert_eq!(found(range(7.0, 7.0_f64.next_up(), 10_000)), ["/speeds/count"]);
        assert_eq!(found(range(1e-9, 7.0, 3)), ["/speeds/from"]);
        assert!(found(json!([range(7.0, 7.0, 1), range(0.0, 7.0, 2)])).is_empty());
    }

    #[test]
    fn violations_point_into_the_array() {
        let range = |count: u32| json!({"from": 1, "to": 2, "count": count, "unit": "hz"});
        assert_eq!(pointers(json!([])), ["/speeds"]);
        assert_eq!(pointers(json!([range(0), range(2), range(1)])), ["/speeds/0/count", "/speeds/2/count"]);
        assert_eq!(pointers(json!([{"values": [1, -1], "unit": "hz"}])), ["/speeds/0/values/1"]);
        assert_eq!(pointers(json!([range(3), {"from": 1, "unit": "hz"}])), ["/speeds/1"]);
        // Together, whether or not they repeat each other.
        assert_eq!(pointers(json!([range(6_000), range(4_001)])), ["/speeds/1/count"]);
        assert!(resolve(&speeds(json!([range(6_000), range(4_000)]))).is_ok());
        let most = MAX_SPEEDS as u32;
        assert_eq!(pointers(json!([range(most), {"values": [1], "unit": "hz"}])), ["/speeds/1/values"]);
        assert_eq!(pointers(range(most + 1)), ["/speeds/count"]);
    }
}
