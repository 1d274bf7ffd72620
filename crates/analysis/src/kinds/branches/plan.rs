//! Plan of a branch job: work and cost, before it starts.

use std::borrow::Cow;
use std::ops::RangeInclusive;
use std::time::Instant;

use super::family::{KEPT, Scenes};
use crate::calibration::Calibration;
use crate::calibration::effects::EffectSizes;
use crate::calibration::size::StepSize;
use crate::effects::symmetry::result::FoundSymmetry;
use crate::effects::table::planned;
use crate::end_state::Shapes;
use crate::model::{ModelFacts, ReducedSector};
use crate::not_runnable::NotRunnable;
use crate::plan::{basis_bytes, contact_pairs, reduced_bytes, reduced_unknowns, state, warnings};
use crate::resolved::ResolvedBranches;
use crate::result::{BranchesPlan, CostRange, Estimate, PlannedResponse};
use crate::speed_scene::SpeedScene;
use rubmap_wheel::dynamics::steady::branch::follow::MOST_OF_SPAN;
use rubmap_wheel::dynamics::steady::response;
use rubmap_wheel::revision::VERSION;

/// Revolutions of a march that take as long as a point of a branch, with its multipliers and its share of the search between points: half
/// of the fewest and twice the most of four branches, at damping of 5 % and 1 %, over speed and clearance.
const REVOLUTIONS: RangeInclusive<u64> = 20..=260;

/// Plans resolved branches; without `reduced`, as far as the facts allow. The caller adds the measured machine.
pub(crate) fn plan_branches(
    asked: &ResolvedBranches,
    facts: &ModelFacts,
    reduced: Option<&ReducedSector>,
    calibration: &Calibration,
) -> BranchesPlan {
    let sweep = asked.sweep();
    let point = reduced.map(|reduced| plan_point(reduced, asked, calibration));
    let points_at_least = points_at_least(asked);
    let estimate = reduced.zip(point.as_ref()).and_then(|(reduced, point)| {
        let one = point.computing_time_s?;
        let points = f64::from(points_at_least);
        let all = CostRange { free: points * one.free, contact: points * one.contact };
        let memory = branches_memory(reduced, asked);
        let revolutions = u64::from(points_at_least) * REVOLUTIONS.end();
        Some(Estimate {
            steps: revolutions * u64::from(point.steps_per_revolution),
            computing_time_s: all,
            wall_time_s: all,
            workers: 1,
            memory_bytes: reduced_bytes(reduced) + memory,
            speed_memory_bytes: memory,
        })
    });
    BranchesPlan {
        effects: planned(&sweep.scene),
        symmetry: FoundSymmetry::of(&sweep.scene, facts.sectors),
        contact_pairs: contact_pairs(&sweep.scene, facts),
        reduction: state(reduced),
        reduced_unknowns_at_most: reduced_unknowns(facts, reduced, sweep.modes_per_speed()),
        basis_bytes_at_most: basis_bytes(facts, reduced, sweep.modes_per_speed(), sweep.fields()),
        machine: None,
        points_at_least,
        points_at_most: 1 + sides(asked) * asked.most_points,
        point,
        estimate,
        warnings: warnings(&sweep.scene, facts, reduced),
        settings: asked.clone().into(),
        version: VERSION.to_owned(),
    }
}

/// Number of directions in which the first branch is followed.
fn sides(asked: &ResolvedBranches) -> u32 {
    let (start, along) = (asked.start(), asked.along);
    u32::from(along.from < start) + u32::from(start < along.to)
}

/// Fewest points: those of a branch that never turns back, takes the longest steps and reaches both ends of its range.
fn points_at_least(asked: &ResolvedBranches) -> u32 {
    let (start, along) = (asked.start(), asked.along);
    let longest = MOST_OF_SPAN * (along.to - along.from);
    // Round-off above a whole number of steps is not another step.
    let steps = |way: f64| ((way / longest - 1e-9).ceil() as u32).min(asked.most_points);
    1 + steps((start - along.from).max(0.0)) + steps((along.to - start).max(0.0))
}

fn plan_point(
    reduced: &ReducedSector,
    asked: &ResolvedBranches,
    calibration: &Calibration,
) -> PlannedResponse {
    priced_point(reduced, asked, calibration)
        .unwrap_or_else(|reason| PlannedResponse { message: Some(reason.to_string()), ..Default::default() })
}

fn priced_point(
    reduced: &ReducedSector,
    asked: &ResolvedBranches,
    calibration: &Calibration,
) -> Result<PlannedResponse, NotRunnable> {
    let scenes = Scenes::new(reduced, asked)?;
    let clock = Instant::now();
    let scene = scenes.at(asked.start())?;
    let set_up = clock.elapsed().as_secs_f64();
    let SpeedScene { request, wheel, stepping, .. } = &scene.at_speed;
    let nodes = scene.at_speed.touching();
    let unknowns = stepping.scheme.integrated_unknowns(wheel);
    let size = StepSize { sectors: wheel.sectors, nodes, unknowns };
    let effects = EffectSizes::of(&request.scene, wheel, stepping.scheme, nodes);
    let (free, contact) = calibration.step_seconds(size, &effects);
    let steps_per_revolution = stepping.discretisation.per_revolution;
    let steps = |revolutions: &u64| (revolutions * steps_per_revolution as u64) as f64;
    Ok(PlannedResponse {
        message: None,
        integrated_unknowns: unknowns as u32,
        scheme: Some(scenes.report().clone()),
        steps_per_revolution: steps_per_revolution as u32,
        computing_time_s: Some(CostRange {
            free: set_up + steps(REVOLUTIONS.start()) * free,
            contact: set_up + steps(REVOLUTIONS.end()) * contact,
        }),
    })
}

/// Memory that branches take while they are followed, in bytes: a run of the scene at the start, the search for its response, and the modes
/// of the other values that are kept.
pub(crate) fn branches_memory(reduced: &ReducedSector, asked: &ResolvedBranches) -> u64 {
    let sweep = Cow::Borrowed(asked.sweep());
    let Ok(scene) = SpeedScene::new(reduced, sweep, asked.speed_rad_s()) else { return 0 };
    let wheel = &scene.wheel;
    let search = response::memory(wheel.unknowns(), wheel.sectors * scene.touching()) as u64;
    KEPT as u64 * (scene.running_bytes() + Shapes::bytes(wheel)) + search
}
