//! Checks of operating ranges and limits.

use std::collections::BTreeSet;

use super::findings::Findings;
use super::limits;
use crate::request::{HIGHEST_SPEED, OperatingRange, Operation};
use crate::resolved::ResolvedSweep;

/// Checks the operation, the limits and the given thickness of a sweep.
pub(super) fn check_operation(found: &mut Findings, sweep: &ResolvedSweep) {
    if let Some(Operation { ranges }) = &sweep.operation {
        check_ranges(found, ranges);
    }
    found.require(
        sweep.blade_thickness.is_none_or(|thickness| limits::LENGTH.contains(&thickness)),
        "/blade_thickness",
        "a thickness is a finite number above 0",
    );
    let Some(asked) = sweep.limits else { return };
    let all = [
        ("clearance_consumption", asked.clearance_consumption),
        ("tip_motion", asked.tip_motion),
        ("utilisation", asked.utilisation),
        ("node_force", asked.node_force),
    ];
    for (field, limit) in all {
        found.require(
            limit.is_none_or(|limit| limits::LENGTH.contains(&limit)),
            &format!("/limits/{field}"),
            "a limit is a finite number above 0",
        );
    }
    found.require(
        asked.utilisation.is_none() || sweep.record.stress.is_some(),
        "/limits/utilisation",
        "utilisation needs stress, and the model has no mesh to compute it from: leave this limit out",
    );
}

fn check_ranges(found: &mut Findings, ranges: &[OperatingRange]) {
    let pointer = "/operation/ranges";
    found.require(!ranges.is_empty(), pointer, "give at least one range, or leave `operation` away");
    found.require(
        ranges.len() <= limits::RANGES,
        pointer,
        format!("at most {} operating ranges", limits::RANGES),
    );
    let mut names = BTreeSet::new();
    for (index, range) in ranges.iter().enumerate().take(limits::RANGES) {
        let at = |field: &str| format!("{pointer}/{index}/{field}");
        let OperatingRange { name, from, to, unit, separation_percent } = range;
        let length = name.trim().chars().count();
        found.require(
            (1..=limits::RANGE_NAME).contains(&length),
            &at("name"),
            format!("a name has 1 to {} characters", limits::RANGE_NAME),
        );
        found.require(
            names.insert(name.trim()),
            &at("name"),
            "another range has this name: give each one its own",
        );
        for (field, speed) in [("from", from), ("to", to)] {
            found.require(
                (0.0..=HIGHEST_SPEED).contains(&(speed * unit.rad_s())),
                &at(field),
                format!("a speed lies between 0 and {HIGHEST_SPEED:e} rad/s, unlike {speed}"),
            );
        }
        found.require(
            *from != 0.0,
            &at("from"),
            "a range begins above 0, as no contact can be simulated at rest: give the lowest speed that counts",
        );
        found.require(from < to, &at("to"), format!("a range ends above {from}, where it begins"));
        found.require(
            separation_percent.is_none_or(|percent| limits::PERCENT.contains(&percent)),
            &at("separation_percent"),
            "a distance between 0 and 100 per cent of the end's speed",
        );
    }
}
