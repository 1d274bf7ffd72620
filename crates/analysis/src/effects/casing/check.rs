//! Checks of the casing.

use std::f64::consts::TAU;

use super::request::Lobes;
use super::resolved::Clearance;
use super::steps::least_steps;
use crate::model::ModelFacts;
use crate::request::AutoOr;
use crate::resolve::findings::{Findings, between, check_reach};
use crate::resolve::limits;
use crate::resolved::{ResolvedSweep, Scene};
use rubmap_wheel::dynamics::casing::Restriction;

const MOST_LOBES: u32 = 100;
const LEAST_WIDTH_RAD: f64 = 1e-4;
/// Two equal Gaussians exp(−(φ/w)²) have a valley between them up to this ratio of w to their distance.
const WIDTH_OVER_DISTANCE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Shortest ramp of lobes that stand inside the blade.
const LEAST_RAMP_REVOLUTIONS: f64 = 0.05;

/// Clearance and lobes.
pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let Some(casing) = &request.scene.casing else { return };
    let valid = |length: f64| length == 0.0 || limits::LENGTH.contains(&length);
    let radius = facts.contact_radius.filter(|radius| *radius > 0.0).unwrap_or(f64::INFINITY);
    let fits = |length: f64| valid(length) && length <= radius;
    let message = format!(
        "a clearance is 0 or a length {}, no larger than the radius at which the tips lie",
        between(&limits::LENGTH)
    );
    match &casing.clearance {
        Clearance::AlongChord { leading, trailing } => {
            found.require(fits(*leading), "/scene/casing/clearance/leading", &message);
            found.require(fits(*trailing), "/scene/casing/clearance/trailing", &message);
        }
        Clearance::Each(values) => {
            found.require(
                values.len() == facts.contact_nodes as usize,
                "/scene/casing/clearance/values",
                format!("the model has {} contact nodes, not {}", facts.contact_nodes, values.len()),
            );
            for (index, &value) in values.iter().enumerate() {
                found.require(fits(value), &format!("/scene/casing/clearance/values/{index}"), &message);
            }
        }
    }
    if let Some(lobes) = &casing.lobes {
        check_lobe_count(found, lobes.count, "/scene/casing/lobes/count");
        found.require(
            valid(lobes.amplitude),
            "/scene/casing/lobes/amplitude",
            format!("a lobe's height is 0 or a length {}", between(&limits::LENGTH)),
        );
        check_reach(found, lobes.amplitude, "/scene/casing/lobes/amplitude", facts);
        let least = LEAST_WIDTH_RAD;
        let most = WIDTH_OVER_DISTANCE * TAU / f64::from(lobes.count.max(1));
        found.require(
            (least..=most).contains(&lobes.width_rad),
            "/scene/casing/lobes/width_rad",
            format!(
                "the half-width of a lobe is at least {least} rad and of {} lobes at most {most:.6} rad: between wider ones there is no \
                 valley",
                lobes.count
            ),
        );
        found.require(
            lobes.phase_rad.abs() <= limits::PHASE_RAD,
            "/scene/casing/lobes/phase_rad",
            format!("the phase is an angle of at most {} rad", limits::PHASE_RAD),
        );
    }
}

/// The number of lobes that is asked for at `pointer` of a request.
pub(crate) fn check_lobe_count(found: &mut Findings, count: u32, pointer: &str) {
    found.require(
        (1..=MOST_LOBES).contains(&count),
        pointer,
        format!("a casing has 1 to {} lobes", MOST_LOBES),
    );
}

/// Steps wider than a lobe would pass it by, with numbers that look fine.
pub(crate) fn check_steps(found: &mut Findings, request: &ResolvedSweep) {
    let AutoOr::Fixed(steps) = request.integration.steps_per_revolution else { return };
    let wide = |lobes: &Lobes| lobes.width_rad >= LEAST_WIDTH_RAD;
    if !request.scene.touched_lobes().is_some_and(wide) {
        return;
    }
    let seen = least_steps(&request.scene);
    found.require(
        f64::from(steps) >= seen,
        "/integration/steps_per_revolution",
        format!(
            "{steps} steps per revolution pass the lobes by, which are seen from {seen} steps per revolution on; give at least \
             {seen}, or \"auto\""
        ),
    );
}

/// Without a ramp a restriction inside the blade would hit it as a step: forces scale as 1/h, nothing converges.
pub(crate) fn check_ramp(found: &mut Findings, request: &ResolvedSweep) {
    if found.refused(Clearance::AT) {
        return;
    }
    let Scene { casing: Some(casing), contact: Some(_), .. } = &request.scene else { return };
    let restriction = match &casing.lobes {
        Some(lobes) if lobes.count > MOST_LOBES => return,
        Some(lobes) => {
            let Lobes { count, amplitude, width_rad, phase_rad } = *lobes;
            Restriction { count, amplitude, width_rad, phase_rad }.highest()
        }
        None => 0.0,
    };
    let orbit = request.scene.orbit.as_ref().map_or(0.0, |orbit| orbit.radius);
    let smallest = casing.clearance.smallest();
    let highest = restriction + orbit;
    found.require(
        request.integration.ramp_revolutions >= LEAST_RAMP_REVOLUTIONS || highest <= smallest,
        "/integration/ramp_revolutions",
        format!(
            "lobes and orbit of up to {highest} reach inside the blade at rest (smallest clearance {smallest}): let them \
             grow over at least {} revolutions",
            LEAST_RAMP_REVOLUTIONS
        ),
    );
}
