//! Validity of linear theory, measured at the speeds of a finished sweep that matter, and scaled to the others.

use std::borrow::Cow;

use crate::error::AnalysisError;
use crate::model::{ModelFacts, ReducedSector};
use crate::monitor::Monitor;
use crate::nonlinear::{
    LargestMotion, MeasuredMotion, Neglected, NotMeasured, PHASE, expected_bytes, relaxing_seconds,
};
use crate::resolved::ResolvedSweep;
use crate::result::{CostRange, Estimate, Point, Validity, ValidityMeasure};
use crate::speed::state_before;
use crate::speed_scene::{Recording, SpeedScene, Start};
use crate::tips::wheel_peaks;
use crate::validity::{beside, geometric, is_open, thickness, unmeasured};
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::integrate::{Outcome, Revolutions};
use rubmap_wheel::dynamics::states::WheelStates;

/// Largest number of speeds at which validity is measured; each is simulated a second time.
const MOST: usize = 6;

/// Largest number of speeds of this sweep at which validity is measured; 0 where it cannot be.
pub(crate) fn most(request: &ResolvedSweep, facts: &ModelFacts) -> u32 {
    let asked = request.fields() != Some(false) && !request.scene.blades_stiffen();
    if asked && facts.mesh.is_some() { request.speeds.count().min(chosen_at_most(request) as u32) } else { 0 }
}

/// Most speeds that are chosen: a single one in a sweep up or down, since all speeds before it are simulated, too.
fn chosen_at_most(request: &ResolvedSweep) -> usize {
    if request.chain().is_some() { 1 } else { MOST }
}

/// Cost of a sweep with that of measuring validity: none where nothing moves far, otherwise all speeds that may be measured once more, one
/// after the other, with the fields of their sectors relaxed on all `threads`.
pub(crate) fn with_cost(
    all: Estimate,
    request: &ResolvedSweep,
    facts: &ModelFacts,
    threads: usize,
) -> Estimate {
    let (Some(mesh), most @ 1..) = (&facts.mesh, most(request, facts)) else { return all };
    let speeds = request.speeds.count();
    let again = if request.chain().is_some() { speeds } else { most };
    let simulated = f64::from(again) * all.computing_time_s.contact / f64::from(speeds);
    let relaxed = relaxing_seconds(facts.own_dofs, most);
    let at_most = |contact: f64| CostRange { free: 0.0, contact };
    let measuring = Estimate {
        steps: 0,
        computing_time_s: at_most(simulated + relaxed),
        wall_time_s: at_most(simulated + relaxed / threads.max(1) as f64),
        workers: 1,
        memory_bytes: expected_bytes(mesh.elements as usize, facts.own_dofs as usize, most as usize),
        speed_memory_bytes: 0,
    };
    all.followed_by(measuring)
}

/// Speeds of a finished sweep at which validity is to be measured, ascending by index: of those that geometry leaves open, the largest motion,
/// the most severe peaks, and the smallest motion, whose shape is another.
pub fn speeds_to_measure(request: &ResolvedSweep, reduced: &ReducedSector, points: &[Point]) -> Vec<u32> {
    let open = |point: &Point| {
        let validity = point.validity.as_ref().filter(|validity| is_open(validity, request))?;
        Some((point.index, displacement(validity, reduced, request)?))
    };
    let candidates: Vec<(u32, f64)> = points.iter().filter_map(open).collect();
    let larger = |a: &&(u32, f64), b: &&(u32, f64)| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0));
    let ends = [candidates.iter().max_by(larger), candidates.iter().min_by(larger)];
    let mut chosen: Vec<u32> = ends.into_iter().flatten().map(|&(index, _)| index).collect();
    chosen.dedup();
    chosen.truncate(chosen_at_most(request));
    let is_candidate = |index: &u32| candidates.iter().any(|(candidate, _)| candidate == index);
    let peaks = wheel_peaks(request, points, None);
    for index in peaks.iter().map(|peak| peak.index).filter(is_candidate) {
        if chosen.len() < chosen_at_most(request) && !chosen.contains(&index) {
            chosen.push(index);
        }
    }
    chosen.sort_unstable();
    chosen
}

/// Repeats the simulation of speed `index` of a sweep, to the bit, in a sweep up or down with all speeds before it, and finds the largest motion
/// of its last revolution; none where the speed is not completed or nothing moves.
///
/// # Errors
/// Cancellation.
pub fn largest_motion(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    index: u32,
    monitor: &dyn Monitor,
) -> Result<Option<LargestMotion>, AnalysisError> {
    let before = state_before(reduced, request, index as usize, monitor)?;
    let start = before.as_ref().map_or(Start::Scene, Start::After);
    let watch = |fraction: f64| {
        monitor.progress(fraction, PHASE);
        !monitor.is_cancelled()
    };
    let speed_rad_s = request.speeds.rad_s()[index as usize];
    let Ok(scene) = SpeedScene::new(reduced, Cow::Borrowed(request), speed_rad_s) else { return Ok(None) };
    let recording = Recording { detail: None, states: Some(Revolutions::Last(1)) };
    let Ok(simulated) = scene.simulate(start, recording, &watch) else { return Ok(None) };
    match &simulated.run.outcome {
        Outcome::Cancelled => Err(AnalysisError::Cancelled),
        Outcome::Completed(history) => {
            let stiffening = request.scene.centrifugal_stiffening;
            let states = history.states.as_ref();
            let states = states
                .and_then(|states| WheelStates::of(states, &scene.wheel, &reduced.wheel, stiffening).ok());
            Ok(states.and_then(|states| {
                LargestMotion::of(index, &states, &reduced.wheel, scene.lasting_clearance())
            }))
        }
        _ => Ok(None),
    }
}

/// Puts measures in the place of guesses by geometry. Where geometry leaves a speed open that was not measured, those of the other
/// motions are scaled, if one of them is larger, and the worst counts, since shapes differ: the excess energy in proportion to the motion, in which it is of first
/// order for a blade that is curved, the second-order motion by its square. A speed without a measure is told why.
pub fn judge_by_measures(
    points: &mut [Point],
    (reduced, request): (&ReducedSector, &ResolvedSweep),
    measured: &Result<Vec<MeasuredMotion>, NotMeasured>,
) {
    for point in points {
        let Some(validity) = &point.validity else { continue };
        if !is_open(validity, request) {
            continue;
        }
        let Some(displacement) = displacement(validity, reduced, request) else { continue };
        match measured {
            Err(error) => point.validity = Some(unmeasured(validity, &error.to_string())),
            Ok(measured) => {
                let own = measured.iter().find(|motion| motion.index == point.index);
                let is_larger = |motion: &&MeasuredMotion| motion.displacement >= displacement;
                let bounded = measured.iter().any(|motion| is_larger(&motion) && motion.neglected.is_ok());
                let others = || measured.iter().filter(|motion| bounded || is_larger(motion)).collect();
                let candidates: Vec<&MeasuredMotion> = own.map_or_else(others, |own| vec![own]);
                let worst = |of: &dyn Fn(&Neglected, f64) -> Option<f64>| {
                    let value = |motion: &&MeasuredMotion| {
                        let neglected = motion.neglected.as_ref().ok()?;
                        Some((of(neglected, displacement / motion.displacement)?.abs(), motion.index))
                    };
                    candidates.iter().filter_map(value).max_by(|a, b| a.0.total_cmp(&b.0))
                };
                let failure = || candidates.iter().find_map(|motion| motion.neglected.err());
                if let Some(excess) = worst(&|neglected, scale| Some(neglected.excess * scale)) {
                    let from = |(value, index): (f64, u32)| (value, (index != point.index).then_some(index));
                    // The scene simulates this change of the gap where blades bend far.
                    let is_linear = request.scene.geometric_nonlinearity.is_none();
                    let gap = worst(&|neglected, scale| Some(neglected.gap? * scale.powi(2)));
                    let gap = gap.filter(|_| is_linear).map(from);
                    point.validity = Some(beside(validity, from(excess), gap));
                } else if let Some(reason) = failure() {
                    point.validity = Some(unmeasured(validity, &reason.to_string()));
                }
            }
        }
    }
}

/// Largest displacement of a contact node, from its ratio to a length of the blade.
fn displacement(validity: &Validity, reduced: &ReducedSector, request: &ResolvedSweep) -> Option<f64> {
    let positions: Vec<[f64; 3]> = reduced.wheel.contact.iter().map(|node| node.position).collect();
    let chord = arc_lengths(&positions).last().copied();
    geometric(validity).find_map(|check| match check.what {
        ValidityMeasure::DisplacementOverThickness => Some(check.value * thickness(reduced, request)?),
        ValidityMeasure::DisplacementOverChord => Some(check.value * chord?),
        _ => None,
    })
}
