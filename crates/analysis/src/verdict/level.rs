//! Level of the wheel over speed, from the same values as the verdict.

use super::evidence::Evidence;
use super::judge::judge;
use super::limit::{Asked, standing};
use super::points::is_completed;
use crate::resolved::ResolvedSweep;
use crate::result::{LevelSpeed, LevelValue, LimitKind, Point, SweepLevel};
use rubmap_wheel::dynamics::sector::Units;

/// Values of all finished speeds beside the verdict on them.
pub fn level(request: &ResolvedSweep, units: &Units, evidence: Evidence<'_>) -> SweepLevel {
    let asked = Asked::of(request, evidence.errors);
    let value = |point: &Point, quantity: LimitKind| {
        let (value, error) = asked.known(point, quantity)?;
        let limit = asked.limits.iter().find(|(kind, _)| *kind == quantity);
        let standing = limit.map(|(_, allowed)| standing(value, *allowed, error));
        Some(LevelValue { quantity, value, error: error.map(|error| error * value), standing })
    };
    let speed = |point: &Point| LevelSpeed {
        index: point.index,
        speed_rad_s: point.speed_rad_s,
        status: point.status,
        values: match is_completed(point) {
            true => LimitKind::ALL.into_iter().filter_map(|quantity| value(point, quantity)).collect(),
            false => Vec::new(),
        },
    };
    let mut speeds: Vec<LevelSpeed> = evidence.points.iter().map(speed).collect();
    speeds.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
    SweepLevel { verdict: judge(request, units, evidence), speeds }
}
