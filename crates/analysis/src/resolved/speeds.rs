//! Speeds of a job as numbers.

use crate::error::Violation;
use crate::request::speeds::{SpeedSet, SpeedUnit, Speeds};

/// Speeds in the order of their indices: those asked for, then, list by list, those that rounds of `refine` have added.
#[derive(Debug, Clone, PartialEq)]
pub struct ResolvedSpeeds {
    /// The lists as they were given, and one for every round.
    lists: Speeds,
    /// Number of the last lists that are rounds of `refine`.
    rounds: u32,
    rad_s: Vec<f64>,
    /// Number of speeds in `rad_s` from each list.
    counts: Vec<usize>,
}

impl ResolvedSpeeds {
    /// Resolves `lists`, the last `rounds` of which a refinement has added.
    ///
    /// # Errors
    /// Violations, each at its JSON pointer.
    pub(crate) fn of(lists: Speeds, rounds: u32) -> Result<Self, Vec<Violation>> {
        let parts = lists.parts()?;
        if rounds as usize >= parts.len() {
            let message = format!("{rounds} rounds cannot have added all of {} lists", parts.len());
            return Err(vec![Violation::new("/speeds", message)]);
        }
        let counts = parts.iter().map(Vec::len).collect();
        let rad_s = parts.concat();
        Ok(Self { lists, rounds, rad_s, counts })
    }

    /// Stand-in for speeds that were refused: no speeds at all.
    pub(crate) fn none() -> Self {
        Self { lists: Speeds::Several(Vec::new()), rounds: 0, rad_s: Vec::new(), counts: Vec::new() }
    }

    /// A single speed.
    pub(crate) fn one(speed_rad_s: f64) -> Self {
        let lists = Speeds::One(list(vec![speed_rad_s]));
        Self { lists, rounds: 0, rad_s: vec![speed_rad_s], counts: vec![1] }
    }

    /// All speeds, rad/s, by index.
    pub fn rad_s(&self) -> &[f64] {
        &self.rad_s
    }

    /// All speeds, rad/s, in ascending order.
    pub fn ascending(&self) -> Vec<f64> {
        let mut speeds = self.rad_s.clone();
        speeds.sort_by(f64::total_cmp);
        speeds
    }

    /// Lowest and highest speed, rad/s; none without speeds.
    pub(crate) fn span_rad_s(&self) -> Option<[f64; 2]> {
        let all = || self.rad_s.iter().copied();
        Some([all().reduce(f64::min)?, all().reduce(f64::max)?])
    }

    /// Number of speeds.
    pub fn count(&self) -> u32 {
        self.rad_s.len() as u32
    }

    /// Number of speeds that were asked for, without those that rounds of `refine` have added.
    pub fn asked(&self) -> usize {
        self.counts[..self.counts.len() - self.rounds as usize].iter().sum()
    }

    /// Speeds of each list that no earlier one has, with the JSON pointer to the list.
    pub(crate) fn by_list(&self) -> impl Iterator<Item = (String, &[f64])> {
        let mut rest = &self.rad_s[..];
        self.counts.iter().enumerate().map(move |(index, &count)| {
            let (speeds, after) = rest.split_at(count);
            rest = after;
            let pointer = match &self.lists {
                Speeds::One(_) => "/speeds".to_owned(),
                Speeds::Several(_) => format!("/speeds/{index}"),
            };
            (pointer, speeds)
        })
    }

    /// Number of rounds of `refine` that have added speeds.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Lists of the speeds, as a request would name them.
    pub fn lists(&self) -> &Speeds {
        &self.lists
    }

    /// Speeds with a round of `speeds_rad_s` after them: no speed changes its index. None if none of the added speeds is new, or there is no room for
    /// them.
    pub(crate) fn with_round(&self, speeds_rad_s: Vec<f64>) -> Option<Self> {
        let mut lists = match &self.lists {
            Speeds::One(set) => vec![set.clone()],
            Speeds::Several(sets) => sets.clone(),
        };
        lists.push(list(speeds_rad_s));
        let more = Self::of(Speeds::Several(lists), self.rounds + 1).ok()?;
        (more.rad_s.len() > self.rad_s.len()).then_some(more)
    }
}

fn list(speeds_rad_s: Vec<f64>) -> SpeedSet {
    SpeedSet { from: None, to: None, count: None, values: Some(speeds_rad_s), unit: SpeedUnit::RadS }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::MAX_SPEEDS;
    use serde_json::{Value, json};

    fn speeds(given: Value) -> ResolvedSpeeds {
        ResolvedSpeeds::of(serde_json::from_value(given).unwrap(), 0).unwrap()
    }

    #[test]
    fn added_speeds_change_no_index() {
        for given in [
            json!({"values": [5, 5, 7], "unit": "rad_s"}),
            json!([{"values": [5, 5], "unit": "rad_s"}, {"from": 5, "to": 7, "count": 2, "unit": "rad_s"}]),
        ] {
            let asked = speeds(given);
            let once = asked.with_round(vec![6.0]).unwrap();
            let more = once.with_round(vec![5.5, 6.5]).unwrap();
            assert_eq!(more.rad_s(), [5.0, 5.0, 7.0, 6.0, 5.5, 6.5]);
            assert_eq!((more.asked(), more.rounds()), (asked.rad_s().len(), 2));
            assert_eq!(more.lists().room(), asked.lists().room() - 3);
            // Read again, they are the same; asked for anew, all are asked for.
            assert_eq!(ResolvedSpeeds::of(more.lists().clone(), 2).unwrap(), more);
            assert_eq!(ResolvedSpeeds::of(more.lists().clone(), 0).unwrap().asked(), 6);
            assert!(ResolvedSpeeds::of(more.lists().clone(), 9).is_err(), "somebody asked for the first");
            let by_list: Vec<f64> = more.by_list().flat_map(|(_, speeds)| speeds.to_vec()).collect();
            assert_eq!(by_list, more.rad_s());
            assert!(more.with_round(vec![6.0]).is_none(), "it is there");
        }
        let most = speeds(json!({"from": 1, "to": 2, "count": MAX_SPEEDS - 1, "unit": "rad_s"}));
        assert_eq!(most.lists().room(), 1);
        assert_eq!(most.with_round(vec![3.0]).unwrap().lists().room(), 0);
    }
}
