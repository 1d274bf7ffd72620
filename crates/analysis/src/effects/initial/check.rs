//! Checks of the state to start from.

use super::request::InitialWave;
use crate::model::ModelFacts;
use crate::resolve::findings::{Findings, between, check_reach};
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    const AT: &str = "/scene/initial";
    let Some(initial) = &request.scene.initial else { return };
    found.require(
        initial.nodal_diameter <= facts.sectors / 2,
        &format!("{AT}/nodal_diameter"),
        format!("the wheel has nodal diameters 0 to {}", facts.sectors / 2),
    );
    found.require(
        (1..=limits::FAMILIES).contains(&initial.family),
        &format!("{AT}/family"),
        format!("modal families are counted from 1 to {}", limits::FAMILIES),
    );
    found.require(
        limits::LENGTH.contains(&initial.amplitude),
        &format!("{AT}/amplitude"),
        format!("an amplitude is a length {}", between(&limits::LENGTH)),
    );
    let single = initial.nodal_diameter == 0 || 2 * initial.nodal_diameter == facts.sectors;
    found.require(
        initial.wave == InitialWave::Standing || !single,
        &format!("{AT}/wave"),
        format!("modes of nodal diameter {} can only stand", initial.nodal_diameter),
    );
    // Without contact the response is linear and may be of any size.
    if request.scene.contact.is_some() {
        check_reach(found, initial.amplitude, &format!("{AT}/amplitude"), facts);
    }
}
