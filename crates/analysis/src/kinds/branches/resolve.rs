//! Branch requests, checked against their model.

use crate::effects::casing::resolved::Clearance;
use crate::effects::damping::request::Damping;
use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::{
    Along, BranchParameter, BranchesRequest, CaseSpeed, HIGHEST_SPEED, LOWEST_SPEED, SteadyChoice,
};
use crate::resolve::findings::Findings;
use crate::resolve::plain_sweep::{PlainSweep, one};
use crate::resolved::scene::Scene;
use crate::resolved::{ResolvedBranches, ResolvedSweep};
use rubmap_wheel::dynamics::integrate::{PassageError, comes_round};

/// Range of multiples of the scene's value over which a branch may be followed.
const MULTIPLES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Range of the largest number of points of a branch on either side.
const POINTS: std::ops::RangeInclusive<u32> = 1..=10_000;

/// Parses a branch request and checks it against its model.
pub(crate) fn resolve_branches(
    request: BranchesRequest,
    facts: &ModelFacts,
) -> Result<ResolvedBranches, Vec<Violation>> {
    let CaseSpeed { value, unit } = request.speed;
    let resolved = PlainSweep {
        model: request.model,
        modes_per_speed: request.modes_per_speed,
        speeds: one(request.speed),
        scene: request.scene,
        integration: request.integration,
        sensors: request.sensors,
        max_engine_order: request.max_engine_order,
        fields: None,
    }
    .resolve(facts, "/speed/value");
    let mut found = Findings::default();
    check_range(&mut found, request.along, value);
    found.require(
        POINTS.contains(&request.most_points),
        "/most_points",
        format!("between {} and {} points", POINTS.start(), POINTS.end()),
    );
    let sweep = match resolved {
        Ok(sweep) => sweep,
        Err(violations) => {
            found.0.extend(violations);
            return Err(found.0);
        }
    };
    check_scene(&mut found, request.along, &sweep);
    check_repeats(&mut found, &sweep.scene);
    let along = match request.along.parameter {
        BranchParameter::Speed => {
            let Along { parameter, from, to } = request.along;
            Along { parameter, from: from * unit.rad_s(), to: to * unit.rad_s() }
        }
        _ => request.along,
    };
    let (doubled, most_points) = (request.doubled, request.most_points);
    if along.parameter == BranchParameter::Speed {
        let speeds = [along.from, along.to];
        for (speed, field) in speeds.into_iter().zip(["/along/from", "/along/to"]) {
            found.require(
                (LOWEST_SPEED..=HIGHEST_SPEED).contains(&speed),
                field,
                format!("a speed between {LOWEST_SPEED:e} and {HIGHEST_SPEED:e} rad/s"),
            );
            found.require(
                !sweep.scene.centrifugal_stiffening || facts.stiffness_reaches(speed),
                field,
                facts.not_extrapolated(),
            );
        }
    }
    found.finish(ResolvedBranches { sweep, along, doubled, most_points })
}

fn check_range(found: &mut Findings, along: Along, speed: f64) {
    let Along { parameter, from, to } = along;
    let (start, what) = match parameter {
        BranchParameter::Speed => (speed, "`speed`"),
        _ => {
            for (value, field) in [(from, "/along/from"), (to, "/along/to")] {
                found.require(
                    MULTIPLES.contains(&value),
                    field,
                    format!(
                        "a multiple of what the scene says, between {} and {}",
                        MULTIPLES.start(),
                        MULTIPLES.end()
                    ),
                );
            }
            (1.0, "1, the scene as it is")
        }
    };
    found.require(
        from.is_finite() && from <= start,
        "/along/from",
        format!("at most {what}, where the branch begins"),
    );
    found.require(
        to.is_finite() && to >= start,
        "/along/to",
        format!("at least {what}, where the branch begins"),
    );
    found.require(from < to, "/along/to", "larger than `from`");
}

/// Requires that the scene has the parameter that changes, with a value other than 0.
fn check_scene(found: &mut Findings, along: Along, sweep: &ResolvedSweep) {
    let scene = &sweep.scene;
    let clear = |clearance: &Clearance| match clearance {
        Clearance::AlongChord { leading, trailing } => leading.max(*trailing) > 0.0,
        Clearance::Each(values) => values.iter().any(|&clearance| clearance > 0.0),
    };
    let damped = |damping: &Damping| {
        damping.modal_ratio > 0.0 || damping.family_ratios.iter().any(|&ratio| ratio > 0.0)
    };
    let casing = scene.casing.as_ref().filter(|_| scene.contact.is_some());
    let lacks = match along.parameter {
        BranchParameter::Speed => None,
        BranchParameter::Clearance => (!casing.is_some_and(|casing| clear(&casing.clearance)))
            .then_some("clearance to a casing that is touched"),
        BranchParameter::LobeAmplitude => {
            let lobes = scene.touched_shape().and_then(|shape| shape.lobes.as_ref());
            (!lobes.is_some_and(|lobes| lobes.amplitude != 0.0)).then_some("casing whose lobes are touched")
        }
        BranchParameter::Damping => (!scene.damping.as_ref().is_some_and(damped)).then_some("damping"),
    };
    if let (BranchParameter::Damping, Some(damping)) = (along.parameter, &scene.damping) {
        let largest =
            damping.family_ratios.iter().fold(damping.modal_ratio, |largest, &ratio| largest.max(ratio));
        found.require(
            along.to * largest < 1.0,
            "/along/to",
            format!("below {:.6}, where ζ would be 1", 1.0 / largest),
        );
    }
    if let Some(lacks) = lacks {
        let message = format!("the scene has no {lacks}: nothing would change");
        found.require(false, "/along/parameter", message);
    }
    found.require(
        sweep.integration.steady == SteadyChoice::March,
        "/integration/steady",
        "branches are always solved for: leave it away",
    );
}

/// Requires that everything the wheel may touch repeats, and that its motion has a tangent.
fn check_repeats(found: &mut Findings, scene: &Scene) {
    found.require(
        scene.geometric_nonlinearity.is_none(),
        "/scene/geometric_nonlinearity",
        format!(
            "{}: remove `geometric_nonlinearity` from the scene, or march its speeds in a sweep",
            PassageError::Bending
        ),
    );
    if scene.contact.is_none() {
        return;
    }
    found.require(scene.abradable.is_none(), "/scene/abradable", PassageError::Coating.to_string());
    found.require(
        scene.clearance_change.is_none(),
        "/scene/clearance_change",
        PassageError::ClearanceChange.to_string(),
    );
    found.require(!scene.has_disc(), "/scene/friction/law", PassageError::Disc.to_string());
    if let Some(orbit) = &scene.orbit
        && let Err(reason) = comes_round(orbit.whirl_ratio)
    {
        found.require(false, "/scene/orbit/whirl_ratio", reason.to_string());
    }
}
