//! Checks of a change of clearances.

use super::request::ClearanceChange;
use crate::effects::casing::check::{LEAST_RAMP_REVOLUTIONS, check_along_chord};
use crate::model::ModelFacts;
use crate::request::SteadyChoice;
use crate::resolve::findings::{Findings, between, check_reach};
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;

const AT: &str = "/scene/clearance_change";
const MOST_POINTS: usize = 1000;
/// Round-off by which decimal numbers that are 0.05 apart may be less.
const ROUND_OFF: f64 = 1e-9;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let Some(ClearanceChange { course, along_chord }) = &request.scene.clearance_change else { return };
    found.require(
        (1..=MOST_POINTS).contains(&course.len()),
        &format!("{AT}/course"),
        format!("1 to {MOST_POINTS} points"),
    );
    let mut before = 0.0;
    for (index, point) in course.iter().enumerate() {
        let at = format!("{AT}/course/{index}");
        found.require(
            point.revolutions - before >= LEAST_RAMP_REVOLUTIONS - ROUND_OFF,
            &format!("{at}/revolutions"),
            format!(
                "points ascend by {LEAST_RAMP_REVOLUTIONS} revolutions at least, from 0: a wall that moves faster would hit the tips with a \
                 force of the step"
            ),
        );
        before = point.revolutions;
        let size = point.change.abs();
        found.require(
            size == 0.0 || limits::LENGTH.contains(&size),
            &format!("{at}/change"),
            format!("a change is 0 or a length {}, of either sign", between(&limits::LENGTH)),
        );
        check_reach(found, size, &format!("{at}/change"), facts);
    }
    let (revolutions, window) = (request.integration.revolutions(), request.integration.window_revolutions);
    found.require(
        f64::from(revolutions) >= before + f64::from(window),
        &format!("{AT}/course"),
        format!(
            "the window would begin before the clearances are where they stay: {before} revolutions of change and {window} of window need \
             more than {revolutions}"
        ),
    );
    found.require(
        request.integration.steady == SteadyChoice::March,
        "/integration/steady",
        "clearances that change take a march: what repeats behind the change depends on how it was come to",
    );
    check_along_chord(found, along_chord.as_deref(), AT, facts);
}
