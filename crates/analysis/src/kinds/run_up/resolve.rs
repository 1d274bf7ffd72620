//! Run-up requests, checked against their model.

use crate::discretisation::Discretisation;
use crate::effects::symmetry::request::Symmetry;
use crate::error::Violation;
use crate::kinds::run_up::cutting::cutting;
use crate::kinds::run_up::resolved::{FRAME, ResolvedCourse};
use crate::model::ModelFacts;
use crate::request::{AutoOr, Integration, RunUpRequest, SpeedSet, SpeedUnit};
use crate::resolve::findings::{Findings, between};
use crate::resolve::limits;
use crate::resolve::plain_sweep::{PlainSweep, values};
use crate::resolved::{ResolvedRunUps, ResolvedSweep};

/// Range of the angle tolerance, rad: finer ones are round-off, coarser ones are of no use for a run-up.
const TOLERANCE: std::ops::RangeInclusive<f64> = 1e-8..=0.1;

/// Most revolutions of all runs together.
const REVOLUTIONS: f64 = 200_000.0;

/// Most segments of all runs together: every plan cuts them, in well below a second.
const PIECES: usize = 500_000;

/// Most frames of a run, and revolutions of a frame.
const FRAMES: u64 = 10_000;
const FRAME_REVOLUTIONS: u64 = 1000;

/// Most amplitudes of all frames of all runs together.
const AMPLITUDES: u64 = 10_000_000;

/// Parses run-ups and checks them against their model.
pub fn resolve_run_ups(request: RunUpRequest, facts: &ModelFacts) -> Result<ResolvedRunUps, Vec<Violation>> {
    let mut found = Findings::default();
    found.require(
        TOLERANCE.contains(&request.angle_tolerance_rad),
        "/angle_tolerance_rad",
        format!("an angle {} rad", between(&TOLERANCE)),
    );
    found.require(
        !request.euler_force || facts.mesh.is_some(),
        "/euler_force",
        "the package of this model has no elements, by which its mass pushes while the speed changes: set this to false, or upload it \
         with its mesh",
    );
    check_limit(&mut found, &request);
    let speed = match ResolvedCourse::of(request.speed) {
        Ok(speed) => speed,
        Err(violations) => {
            found.0.extend(violations);
            return Err(found.0);
        }
    };
    // No revolutions of a sweep bound what grows and closes in a run.
    let course = request.scene.clearance_change.iter().flat_map(|change| &change.course);
    let grown = course.map(|point| point.revolutions).fold(request.integration.ramp_revolutions, f64::max);
    let integration = request.integration.of_sweep();
    let least =
        (grown.clamp(0.0, REVOLUTIONS) as u32 + 1 + integration.window_revolutions).min(limits::REVOLUTIONS);
    let integration =
        Integration { most_revolutions: integration.most_revolutions.max(least), ..integration };
    let sweep = PlainSweep {
        model: request.model,
        modes_per_speed: request.modes_per_speed,
        speeds: ends(&speed),
        scene: request.scene,
        integration,
        sensors: request.sensors,
        max_engine_order: request.max_engine_order,
        fields: None,
    };
    // The numbers that a speed of a sweep records: a frame has fewer, in the same proportion.
    let at_its_field = |violation: Violation| match violation.pointer.as_str() {
        "/integration/most_revolutions" => Violation::new(
            "/sensors",
            "these sensors record more numbers than a run holds: ask for fewer, or for fewer engine orders",
        ),
        _ => violation,
    };
    let sweep = match sweep.resolve(facts, "/speed") {
        Ok(sweep) => sweep,
        Err(violations) => {
            found.0.extend(violations.into_iter().map(at_its_field));
            return Err(found.0);
        }
    };
    check_scene(&mut found, &sweep);
    let resolved = ResolvedRunUps {
        sweep,
        speed,
        euler_force: request.euler_force,
        angle_tolerance_rad: request.angle_tolerance_rad,
        frame_revolutions: request.frame_revolutions,
        limit: request.limit,
    };
    if found.0.is_empty() {
        check_runs(&mut found, &resolved, facts);
    }
    found.finish(resolved)
}

/// Lowest and highest speed, as the speeds of a sweep.
fn ends(speed: &ResolvedCourse) -> SpeedSet {
    let (lowest, highest) = speed.range();
    values(if lowest < highest { vec![lowest, highest] } else { vec![lowest] }, SpeedUnit::RadS)
}

fn check_limit(found: &mut Findings, request: &RunUpRequest) {
    found.require(
        request.limit.is_none_or(|limit| limits::LENGTH.contains(&limit)),
        "/limit",
        format!("a displacement {}", between(&limits::LENGTH)),
    );
    found.require(
        request.limit.is_none() || request.sensors.iter().all(|sensor| sensor.gauge.is_none()),
        "/limit",
        "the limit is a displacement, and a sensor is a strain gauge: leave one of them away",
    );
}

/// Refuses effects with a state of their own, which is not passed from one speed to the next.
fn check_scene(found: &mut Findings, sweep: &ResolvedSweep) {
    let scene = &sweep.scene;
    found.require(
        scene.abradable.is_none(),
        "/scene/abradable",
        "a coating that wears is not simulated while the speed changes: leave it away",
    );
    found.require(
        scene.flexible_casing.is_none(),
        "/scene/flexible_casing",
        "an elastic casing is not simulated while the speed changes: leave it away",
    );
    found.require(
        scene.symmetry == Symmetry::Full,
        "/scene/symmetry",
        "while the speed changes the whole wheel is simulated: \"full\"",
    );
}

fn check_runs(found: &mut Findings, asked: &ResolvedRunUps, facts: &ModelFacts) {
    if let AutoOr::Fixed(frame) = asked.frame_revolutions {
        let frame = u64::from(frame);
        let sound = (1..=FRAME).contains(&frame) || (frame > 0 && frame.is_multiple_of(FRAME));
        found.require(
            sound && frame <= FRAME_REVOLUTIONS,
            "/frame_revolutions",
            format!("1 to {FRAME} revolutions, or a multiple of {FRAME} up to {FRAME_REVOLUTIONS}"),
        );
        if frame == 0 {
            return;
        }
    }
    let samples = Discretisation::of_every_speed(&asked.sweep, facts.sectors as usize);
    let (mut all, mut amplitudes, mut pieces) = (0.0, 0, 0);
    for run in 0..asked.runs() {
        let profile = asked.speed.profile(run);
        let revolutions = profile.revolutions();
        all += revolutions;
        let pointer = match asked.speed {
            ResolvedCourse::Rates { .. } => format!("/speed/rates/{run}"),
            ResolvedCourse::Points { .. } => "/speed/points".to_owned(),
        };
        found.require(
            revolutions >= 1.0,
            &pointer,
            "a run takes at least one revolution: change the speed more slowly",
        );
        found.require(
            all <= REVOLUTIONS,
            &pointer,
            format!(
                "{all:.0} revolutions with this run; all runs together take at most {REVOLUTIONS:.0}: change the speed faster"
            ),
        );
        if !found.0.is_empty() {
            return;
        }
        let ramp = asked.sweep.integration.ramp_revolutions;
        found.require(
            ramp < revolutions,
            "/integration/ramp_revolutions",
            format!("less than the {revolutions:.1} revolutions of run {run}, counted from 0: the casing would never have its height"),
        );
        let frame = asked.frame_revolutions(revolutions);
        let frames = (revolutions.ceil() as u64).div_ceil(frame);
        found.require(
            frames <= FRAMES,
            "/frame_revolutions",
            format!(
                "{frames} frames of a run of {revolutions:.0} revolutions; at most {FRAMES}: make them longer"
            ),
        );
        let lines = u64::from(asked.sweep.max_engine_order) * frame.min(FRAME) + 1;
        amplitudes += frames * lines * asked.sweep.sensors.len() as u64;
        let advice = "allow more by `angle_tolerance_rad`, or change the speed more slowly";
        match cutting(asked, revolutions, samples).segments(&profile) {
            Ok(segments) => pieces += segments.len(),
            Err(reason) => found.require(false, &pointer, format!("{reason}; {advice}")),
        }
        found.require(
            pieces <= PIECES,
            &pointer,
            format!("{pieces} segments of one speed with this run; all runs together take at most {PIECES}: {advice}"),
        );
        // Runs that cannot be cut take as long to look at as runs that can.
        if !found.0.is_empty() {
            return;
        }
    }
    found.require(
        amplitudes <= AMPLITUDES,
        "/max_engine_order",
        format!(
            "spectrograms of {amplitudes} amplitudes in all; at most {AMPLITUDES}: ask for fewer engine orders, sensors or runs, or for longer \
             frames"
        ),
    );
}
