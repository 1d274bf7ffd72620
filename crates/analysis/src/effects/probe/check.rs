//! Checks of the asymmetry to start from.

use super::request::Probe;
use crate::effects::symmetry::request::Symmetry;
use crate::resolve::findings::Findings;
use crate::resolved::Scene;

pub(crate) fn check(found: &mut Findings, scene: &Scene) {
    let Some(Probe { amplitude, .. }) = &scene.probe else { return };
    found.require(
        scene.symmetry == Symmetry::Probe,
        "/scene/probe",
        "this belongs to `\"symmetry\": \"probe\"`",
    );
    found.require(
        (1e-12..=1e-3).contains(amplitude),
        "/scene/probe/amplitude",
        "the asymmetry is 1e-12 to 1e-3 of the smallest clearance",
    );
}
