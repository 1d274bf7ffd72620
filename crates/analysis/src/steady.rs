//! Steady response of a speed: marched to, or solved for.

use crate::effects::casing::shape::Shape;
use crate::effects::damping::convert::ratios;
use crate::effects::symmetry::repeats::repeats as scene_repeats;
use crate::effects::symmetry::request::Symmetry;
use crate::peak_to_peak::half_peak_to_peak;
use crate::request::{AutoOr, Integration, SteadyChoice};
use crate::resolved::ResolvedSweep;
use crate::result::{FloquetMultiplier, MarchReport, Stability, SteadyReport};
use rubmap_wheel::dynamics::integrate::{
    Detail, LEAST_MARCHED, Outcome, Repeated, Repeats, Revolutions, Run, Simulation, revolutions_over_lobe,
};
use rubmap_wheel::dynamics::steady::multipliers::{MOST_PRODUCTS, Multiplier};
use rubmap_wheel::dynamics::steady::periodic::{MOST_BEYOND, NotFound};
use rubmap_wheel::dynamics::steady::response::{self, LEAST_REVOLUTIONS, Response, Sought, record, seek};
use rubmap_wheel::dynamics::steady::stability::Floquet;

/// Limit of a search, and of a march that controls it, as a multiple of the revolutions asked for.
const LIMIT: u32 = 4;

/// Largest number of revolutions of a search.
pub(super) fn most_revolutions(request: &ResolvedSweep) -> usize {
    (LIMIT * request.integration.revolutions()) as usize
}

/// Fewest and most revolutions that a speed takes.
pub(super) fn revolutions_taken(request: &ResolvedSweep) -> [u64; 2] {
    let Integration { revolutions, ramp_revolutions, steady, .. } = request.integration;
    let marched = u64::from(request.integration.revolutions());
    let limit = u64::from(LIMIT) * marched;
    let scene = &request.scene;
    let lobes = scene.touched_shape().and_then(Shape::repeats);
    let orders = scene.engine_order_excitation.iter().map(|force| force.order);
    // Each product is of a lobe, or of as many revolutions as all that turns past the wheel needs to come round.
    let product = revolutions_over_lobe(lobes, orders, scene.orbit.as_ref().map(|orbit| orbit.whirl_ratio));
    let multipliers = (MOST_PRODUCTS as f64 * product) as u64;
    let least = ramp_revolutions.ceil() as u64 + LEAST_REVOLUTIONS;
    // The ramp, and what two searches take beyond their most.
    let begun = ramp_revolutions.ceil() as u64 + 2 * MOST_BEYOND * product.ceil() as u64;
    // Without a tangent there is nothing but the march.
    match if scene.is_marched() { SteadyChoice::March } else { steady } {
        SteadyChoice::March => match revolutions {
            AutoOr::Auto if goes_on(request).is_none() => {
                let changed = request.scene.clearance_change.as_ref().and_then(|change| change.course.last());
                let begun = changed.map_or(ramp_revolutions, |last| ramp_revolutions.max(last.revolutions));
                [(begun.ceil() as u64 + LEAST_MARCHED).min(marched), marched]
            }
            AutoOr::Auto | AutoOr::Fixed(_) => [marched, marched],
        },
        // Two searches, one of them from heavier damping, and the march beside what was found; with `auto` that from where the scene begins.
        SteadyChoice::Periodic => [least, begun + 3 * limit + multipliers + marched],
        SteadyChoice::Auto => [least, begun + 4 * limit + multipliers + marched],
    }
}

/// Conditions under which the march of a scene may end early, once its motion repeats; none if it may not.
pub(super) fn repeats(request: &ResolvedSweep, detail: Option<Detail>, sectors: usize) -> Option<Repeats> {
    let Integration { revolutions: AutoOr::Auto, settled_to, .. } = request.integration else { return None };
    if goes_on(request).is_some() {
        return None;
    }
    let asked = request.histories().and_then(|histories| histories.revolutions).map(|[_, to]| to as usize);
    let recorded = match detail.map(|detail| detail.revolutions) {
        Some(Revolutions::Between(_, to)) => Some(to),
        _ => None,
    };
    let symmetry = match request.scene.symmetry {
        Symmetry::Full => scene_repeats(&request.scene, sectors as u32) as usize,
        Symmetry::Exact | Symmetry::Probe => 1,
    };
    Some(Repeats { share: settled_to, least: asked.max(recorded).unwrap_or(0), symmetry })
}

/// Reason why the march of a scene does not end before its limit; none if it may.
fn goes_on(request: &ResolvedSweep) -> Option<&'static str> {
    if request.is_worn() {
        return Some("a coating that wears changes the motion for as long as it is touched");
    }
    (request.scene.symmetry == Symmetry::Probe).then_some("a probe of the symmetry takes all revolutions")
}

/// Reason why the motion of a scene can never repeat; none if it may.
fn keeps_moving(request: &ResolvedSweep, run: &Run) -> Option<&'static str> {
    let damping = ratios(&request.scene);
    let ratios =
        damping.iter().flat_map(|damping| damping.family_ratios.iter().chain([&damping.modal_ratio]));
    let undamped = damping.is_none() || ratios.into_iter().any(|&ratio| ratio == 0.0);
    (undamped && run.energy.largest_energy() > 0.0).then_some(
        "motion without damping never comes to rest: give damping to all modes, or a number of revolutions",
    )
}

/// Report about the length of a march, for a complete run that was to end once it repeats.
pub(super) fn marched(
    request: &ResolvedSweep,
    run: &Run,
    steady: Option<&SteadyReport>,
) -> Option<MarchReport> {
    let Integration { revolutions: AutoOr::Auto, most_revolutions, .. } = request.integration else {
        return None;
    };
    let Outcome::Completed(history) = &run.outcome else { return None };
    if steady.is_some_and(|steady| steady.taken) {
        return None;
    }
    Some(match history.repeated {
        Some(Repeated { after, period, remaining }) => MarchReport {
            revolutions: (after + period) as u32,
            period_revolutions: Some(period as u32),
            remaining_change: Some(remaining),
            reason: None,
        },
        None => MarchReport {
            revolutions: most_revolutions,
            period_revolutions: None,
            remaining_change: None,
            reason: Some(
                goes_on(request)
                    .or_else(|| keeps_moving(request, run))
                    .unwrap_or("the motion was not found to repeat by the time its longest window began")
                    .to_owned(),
            ),
        },
    })
}

/// Memory that the search of a speed takes beside its run, in bytes.
pub(super) fn memory(request: &ResolvedSweep, unknowns: usize, pairs: usize) -> u64 {
    match request.integration.steady {
        SteadyChoice::March => 0,
        SteadyChoice::Periodic | SteadyChoice::Auto => {
            let directions = if request.scene.friction.is_some() { 2 } else { 1 };
            response::memory(unknowns, directions * pairs) as u64
        }
    }
}

/// Run, with the report about the periodic response if that was asked for.
pub(super) struct Simulated {
    pub(super) run: Run,
    pub(super) steady: Option<SteadyReport>,
}

/// Runs `simulation` by a march or a search, as `request` asks.
pub(super) fn run_steady(
    simulation: &Simulation<'_>,
    request: &ResolvedSweep,
    watch: &dyn Fn(f64) -> bool,
) -> Simulated {
    let choice = request.integration.steady;
    if choice == SteadyChoice::March {
        return Simulated { run: simulation.run(watch), steady: None };
    }
    if request.scene.symmetry == Symmetry::Probe {
        let reason = "a probe of the symmetry is a march".to_owned();
        return march(simulation, SteadyReport { reason: Some(reason), ..nothing(0.0) }, watch);
    }
    watch(0.0);
    let limit = most_revolutions(request);
    let go_on = || watch(0.0);
    let Sought { response, revolutions } = seek(simulation, limit, choice == SteadyChoice::Auto, &go_on);
    let response = match response {
        Ok(response) => response,
        Err(reason) => {
            let reason = (reason != NotFound::Cancelled).then(|| reason.to_string());
            return march(simulation, SteadyReport { reason, ..nothing(revolutions) }, watch);
        }
    };
    let run = record(simulation, &response, watch);
    let reason = why_not(choice, &response, &run);
    let report = SteadyReport {
        taken: reason.is_none(),
        reason,
        half_peak_to_peak: amplitudes(&run),
        ..found(&response, simulation, revolutions)
    };
    if report.taken { Simulated { run, steady: Some(report) } } else { march(simulation, report, watch) }
}

fn march(simulation: &Simulation<'_>, report: SteadyReport, watch: &dyn Fn(f64) -> bool) -> Simulated {
    Simulated { run: simulation.run(watch), steady: Some(report) }
}

/// Reason why the periodic response is not taken as the result of the speed; none if it is.
fn why_not(choice: SteadyChoice, response: &Response, run: &Run) -> Option<String> {
    if !matches!(run.outcome, Outcome::Completed(_) | Outcome::Cancelled) {
        return Some("the periodic response could not be followed for a revolution".to_owned());
    }
    if choice == SteadyChoice::Periodic {
        return None;
    }
    match (response.floquet.stability, response.arrives) {
        (Stability::Stable, Some(true)) => None,
        (Stability::Stable, _) => Some(
            "the periodic response is stable, but the march from where the scene begins did not come to it"
                .to_owned(),
        ),
        (Stability::Narrow, _) => {
            Some("the periodic response attracts only what starts very close to it".to_owned())
        }
        (Stability::Undecided, _) => {
            Some("it could not be told whether the periodic response is stable".to_owned())
        }
        _ => Some("the periodic response is unstable".to_owned()),
    }
}

fn nothing(revolutions: f64) -> SteadyReport {
    SteadyReport {
        taken: false,
        reason: None,
        residual: None,
        stability: None,
        multipliers: Vec::new(),
        lobe_passages: None,
        followed_from_damping: None,
        half_peak_to_peak: Vec::new(),
        revolutions,
    }
}

fn found(response: &Response, simulation: &Simulation<'_>, revolutions: f64) -> SteadyReport {
    let Response { residual, floquet, .. } = response;
    let multiplier = |one: &_| multiplier(floquet, one, simulation);
    SteadyReport {
        residual: Some(*residual),
        stability: Some(floquet.stability),
        multipliers: floquet.multipliers.iter().map(multiplier).collect(),
        lobe_passages: Some(floquet.lobes as u32),
        followed_from_damping: response.followed_from,
        ..nothing(revolutions)
    }
}

pub(super) fn multiplier(
    floquet: &Floquet,
    one: &Multiplier,
    simulation: &Simulation<'_>,
) -> FloquetMultiplier {
    let (index, &share) =
        (one.shares.iter().enumerate()).max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or((0, &0.0));
    FloquetMultiplier {
        real: one.value.re,
        imaginary: one.value.im,
        modulus: one.value.norm(),
        residual: one.residual,
        order_offset: floquet.order_offset(one),
        nodal_diameter: simulation.wheel.harmonics[index].harmonic as u32,
        share,
    }
}

/// Amplitudes of every sensor.
fn amplitudes(run: &Run) -> Vec<f64> {
    let Outcome::Completed(history) = &run.outcome else { return Vec::new() };
    history.displacement.iter().map(|line| half_peak_to_peak(line)).collect()
}
