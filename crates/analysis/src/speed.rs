//! One speed of a sweep: from the reduced sector to spectra with credentials.

use std::borrow::Cow;
use std::time::Instant;

use crate::end_state::{EndState, Shapes};
use crate::error::AnalysisError;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::not_runnable::NotRunnable;
use crate::record::{Recorded, record_run};
use crate::request::SweepDirection;
use crate::resolved::ResolvedSweep;
use crate::result::{Point, PointStatus, SpeedResult, WearMap};
use crate::speed_scene::{Recording, SpeedScene, Start};
use crate::stress::{Course, stress_of};
use crate::validity;
use rubmap_wheel::dynamics::integrate::{Outcome, Run};
use rubmap_wheel::dynamics::states::WheelStates;
use rubmap_wheel::revision::VERSION;
use rubmap_wheel::vectors::vectors;

/// Simulates speed `index` of a sweep, from `start` if it is given: the end of the neighbouring speed of a sweep up or down.
/// Deterministic; runs on the calling thread. A speed that diverges or cannot be
/// evaluated is a result (with its status), not an error; the only error is cancellation.
pub fn run_speed(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    index: usize,
    start: Option<&EndState>,
    monitor: &dyn Monitor,
) -> Result<SpeedResult, AnalysisError> {
    let clock = Instant::now();
    let mut point = empty_point(reduced, request, index, request.speeds.rad_s()[index]);
    let (mut recorded, mut end_state, mut wear) = (None, None, None);
    let watch = |fraction: f64| {
        monitor.progress(fraction, "contact simulation");
        !monitor.is_cancelled()
    };
    let from = start.map_or(Start::Scene, Start::After);
    let scene = SpeedScene::new(reduced, Cow::Borrowed(request), point.speed_rad_s);
    let ran = scene.and_then(|scene| {
        if request.stress_outside().is_some_and(|radius| !reduced.tells_stress(radius)) {
            return Err(NotRunnable::UnreadStress);
        }
        let simulated = scene.simulate(from, Recording::of(request), &watch)?;
        Ok((scene, simulated))
    });
    match ran {
        Err(reason) => point.message = Some(reason.to_string()),
        Ok((scene, simulated)) => {
            recorded = record_run(&mut point, &simulated, &scene)?;
            judge_run(&mut point, &simulated.run, &scene);
            end_state = end_state_of(&simulated.run, &scene);
            wear = simulated.run.coating.as_ref().map(WearMap::of);
        }
    }
    if start.is_none() && follows_another(request, index) {
        point.message = Some(from_the_start(point.message.take()));
    }
    point.wall_time_s = clock.elapsed().as_secs_f64();
    let (spectra, contact) =
        recorded.map_or((None, None), |Recorded { spectra, contact }| (Some(spectra), contact));
    Ok(SpeedResult { point, spectra, wear, contact, end_state })
}

/// State at the end of the speed before `index` in a sweep up or down, by a simulation of all speeds before it.
pub(crate) fn state_before(
    reduced: &ReducedSector,
    sweep: &ResolvedSweep,
    index: usize,
    monitor: &dyn Monitor,
) -> Result<Option<EndState>, AnalysisError> {
    let mut state = None;
    for before in sweep.chain().unwrap_or_default().into_iter().take_while(|&before| before as usize != index)
    {
        state = run_speed(reduced, sweep, before as usize, state.as_ref(), monitor)?.end_state;
    }
    Ok(state)
}

/// Writes the stress and the validity of linear theory into `point`, from a complete run.
pub(super) fn judge_run(point: &mut Point, run: &Run, scene: &SpeedScene<'_>) {
    let Outcome::Completed(history) = &run.outcome else { return };
    let SpeedScene { sector: reduced, request, wheel, .. } = scene;
    let stiffening = request.scene.centrifugal_stiffening;
    if let (Some(modes), Some(stress)) = (&history.states, &reduced.stress) {
        let found = WheelStates::of(modes, wheel, &reduced.wheel, stiffening)
            .map_err(|error| error.to_string())
            .and_then(|states| {
                let course =
                    Course { harmonics: &reduced.wheel.harmonics, wheel, states: &states, stiffening };
                stress_of(stress, &course, request.strengths()).map_err(|error| error.to_string())
            });
        match found {
            Ok(found) => point.stress = found,
            Err(reason) => point.message = Some(format!("stress is not known: {reason}")),
        }
        if point.stress.is_none() && point.message.is_none() {
            let radius = stress.excluded_radius();
            point.message =
                Some(format!("stress is not known: every node lies within {radius} of a contact node"));
        }
    }
    point.validity = Some(validity::judge(&history.excursion, point.stress.as_ref(), reduced, request));
}

/// State from which the next speed of a chain starts, if the sweep is a chain and this speed was integrated to its end.
fn end_state_of(run: &Run, scene: &SpeedScene<'_>) -> Option<EndState> {
    let SpeedScene { sector, request, wheel, .. } = scene;
    let Outcome::Completed(history) = &run.outcome else { return None };
    if request.sweep == SweepDirection::Independent {
        return None;
    }
    let shapes = Shapes::of(wheel, &sector.wheel, request.scene.centrifugal_stiffening).ok()?;
    Some(EndState::new(&history.end, &shapes))
}

/// Whether speed `index` should start from the end of another one.
fn follows_another(request: &ResolvedSweep, index: usize) -> bool {
    let chain = request.chain();
    chain.is_some_and(|chain| chain.first() != Some(&(index as u32)))
}

fn from_the_start(ended: Option<String>) -> String {
    let started = "started as the first speed does, since the neighbouring speed left no state to start from";
    ended.map_or_else(|| started.to_owned(), |ended| format!("{started}; {ended}"))
}

pub(super) fn empty_point(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    index: usize,
    speed_rad_s: f64,
) -> Point {
    let stiffening = request.scene.centrifugal_stiffening;
    Point {
        index: index as u32,
        speed_rad_s,
        status: PointStatus::Failed,
        message: None,
        stiffening: stiffening.then_some(reduced.report.stiffening.verdict),
        settling: None,
        march: None,
        steady: None,
        scheme: None,
        steps_per_revolution: 0,
        smallest_stable_steps_per_revolution: 0,
        steps: 0,
        contact_share: 0.0,
        tip: None,
        running_clearance: Vec::new(),
        contact: None,
        contact_impulse: None,
        largest_penetration: None,
        smallest_multiplier: None,
        energy_residual: None,
        energy: None,
        largest_energy: None,
        casing_amplitude: None,
        sticking_share: None,
        wear: None,
        symmetry_breaking: None,
        stress: None,
        validity: None,
        responses: Vec::new(),
        wall_time_s: 0.0,
        version: VERSION.to_owned(),
        vectors: Some(vectors()),
    }
}
