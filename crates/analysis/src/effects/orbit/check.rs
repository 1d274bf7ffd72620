//! Checks of an orbit.

use crate::model::ModelFacts;
use crate::resolve::findings::{Findings, between, check_reach};
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;

/// Largest whirl ratio, in either direction: the whirl is prescribed and its inertia left out, as for a shaft's own slow whirl.
const MOST_WHIRL_RATIO: f64 = 2.0;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let Some(orbit) = &request.scene.orbit else { return };
    found.require(
        orbit.radius == 0.0 || limits::LENGTH.contains(&orbit.radius),
        "/scene/orbit/radius",
        format!("the radius is 0 or a length {}", between(&limits::LENGTH)),
    );
    check_reach(found, orbit.radius, "/scene/orbit/radius", facts);
    found.require(
        orbit.whirl_ratio.abs() <= MOST_WHIRL_RATIO,
        "/scene/orbit/whirl_ratio",
        format!("whirl is at most {} times as fast as the rotation", MOST_WHIRL_RATIO),
    );
    found.require(
        orbit.phase_rad.abs() <= limits::PHASE_RAD,
        "/scene/orbit/phase_rad",
        format!("the phase is an angle of at most {} rad", limits::PHASE_RAD),
    );
}
