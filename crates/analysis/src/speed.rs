//! One speed of a sweep: from the reduced sector to spectra with credentials.

use std::time::Instant;

use crate::effects::casing::convert::{casing, check_table, running_clearance};
use crate::effects::damping::convert::modal_damping;
use crate::effects::physics::Surroundings;
use crate::effects::table::{SceneEffects, check_at_speed};
use crate::end_state::{EndState, Shapes};
use crate::error::AnalysisError;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::not_runnable::NotRunnable;
use crate::record::{Recorded, record_run};
use crate::request::SweepDirection;
use crate::resolved::ResolvedSweep;
use crate::result::{Point, PointStatus, SpeedResult, WearMap};
use crate::sensed::sensed;
use crate::start::{initial, perturbed};
use crate::steady::{Simulated, marched, repeats, run_steady};
use crate::stepping::Stepping;
use crate::stress::{Course, stress_of};
use crate::validity;
use crate::wheel::wheel_of;
use rubmap_wheel::dynamics::integrate::{Detail, Outcome, Revolutions, Run, Simulation};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
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
    let ran = ready(reduced, request, point.speed_rad_s).and_then(|(wheel, stepping)| {
        if request.stress_outside().is_some_and(|radius| !reduced.tells_stress(radius)) {
            return Err(NotRunnable::UnreadStress);
        }
        let simulated = simulate(reduced, &wheel, request, &stepping, from, Recording::of(request), &watch)?;
        Ok((wheel, stepping, simulated))
    });
    match ran {
        Err(reason) => point.message = Some(reason.to_string()),
        Ok((wheel, stepping, Simulated { run, steady })) => {
            (point.march, point.steady) = (marched(request, &run, steady.as_ref()), steady);
            recorded = record_run(&mut point, &run, request, &wheel, &stepping, reduced)?;
            judge_run(&mut point, &run, reduced, request, &wheel);
            end_state = end_state_of(&run, &reduced.wheel, &wheel, request);
            wear = run.coating.as_ref().map(WearMap::of);
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

/// Writes the stress and the validity of linear theory into `point`, from a complete run.
pub(super) fn judge_run(
    point: &mut Point,
    run: &Run,
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    wheel: &ModalWheel,
) {
    let Outcome::Completed(history) = &run.outcome else { return };
    let stiffening = request.scene.centrifugal_stiffening;
    if let (Some(modes), Some(stress)) = (&history.states, &reduced.stress) {
        let found = WheelStates::of(modes, wheel, &reduced.wheel, stiffening)
            .map_err(|error| error.to_string())
            .and_then(|states| {
                let course =
                    Course { harmonics: &reduced.wheel.harmonics, wheel, states: &states, stiffening };
                stress_of(stress, &course).map_err(|error| error.to_string())
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

/// Wheel of a scene at a speed, with its stepping; or why it cannot be run.
pub(super) fn ready(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    speed_rad_s: f64,
) -> Result<(ModalWheel, Stepping), NotRunnable> {
    let wheel = wheel_of(&request.scene, &reduced.wheel, speed_rad_s)?;
    let stepping = Stepping::choose(&wheel, &reduced.wheel.contact, request)?;
    Ok((wheel, stepping))
}

/// State from which a run starts.
#[derive(Debug, Clone, Copy)]
pub(super) enum Start<'a> {
    /// Initial state of the scene: rest, or the initial mode.
    Scene,
    /// Initial state of the scene with a tiny perturbation of every nodal diameter.
    Perturbed,
    /// End of the neighbouring speed.
    After(&'a EndState),
}

/// State from which the next speed of a chain starts, if the sweep is a chain and this speed was integrated to its end.
fn end_state_of(
    run: &Run,
    reduced: &ReducedWheel,
    wheel: &ModalWheel,
    request: &ResolvedSweep,
) -> Option<EndState> {
    let Outcome::Completed(history) = &run.outcome else { return None };
    if request.sweep == SweepDirection::Independent {
        return None;
    }
    let shapes = Shapes::of(wheel, reduced, request.scene.centrifugal_stiffening).ok()?;
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

/// Additional recording of a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Recording {
    /// Details of chosen revolutions.
    pub(super) detail: Option<Detail>,
    /// Revolutions of which all modes are recorded.
    pub(super) states: Option<Revolutions>,
}

impl Recording {
    /// Recording at every speed of a sweep: the last revolution, if stress is asked for.
    pub(super) fn of(request: &ResolvedSweep) -> Self {
        Self { detail: None, states: request.stress_outside().map(|_| Revolutions::Last(1)) }
    }
}

/// Runs a scene on `wheel`; or says why it cannot be run.
pub(super) fn simulate(
    sector: &ReducedSector,
    wheel: &ModalWheel,
    request: &ResolvedSweep,
    stepping: &Stepping,
    start: Start<'_>,
    recording: Recording,
    watch: &dyn Fn(f64) -> bool,
) -> Result<Simulated, NotRunnable> {
    let reduced = &*sector.wheel;
    // A wheel that comes from another speed is in contact with a casing that is there.
    let ramp_revolutions = match start {
        Start::After(_) => 0.0,
        Start::Scene | Start::Perturbed => request.integration.ramp_revolutions,
    };
    staged(sector, wheel, request, stepping, ramp_revolutions, |staged| {
        let casing = staged.casing;
        let mut initial = match start {
            Start::After(state) => {
                let shapes = Shapes::of(wheel, reduced, request.scene.centrifugal_stiffening)?;
                let modes = state.modes(wheel, &shapes, reduced, stepping.scheme);
                modes.ok_or(NotRunnable::OtherReduction)?
            }
            Start::Scene | Start::Perturbed => initial(request, wheel, &reduced.contact, casing, stepping)?,
        };
        let repeats = repeats(request, recording.detail, wheel.around());
        if matches!(start, Start::Perturbed) {
            initial = perturbed(initial, wheel, casing);
        }
        // Where a march ends early, a motion that breaks the symmetry must not have to grow out of round-off first.
        let aside = (casing.is_some() && repeats.is_some_and(|repeats| repeats.symmetry > 1))
            .then(|| perturbed(initial.clone(), wheel, casing));
        let Recording { detail, states } = recording;
        let simulation = Simulation { initial: &initial, repeats, detail, states, ..staged };
        if let Some(aside) = aside {
            let simulated = run_steady(&Simulation { initial: &aside, ..simulation }, request, watch);
            // A run without contact breaks no symmetry, and would show only its initial perturbation.
            if simulated.run.statistics.contact_share() > 0.0 {
                return Ok(simulated);
            }
        }
        Ok(run_steady(&simulation, request, watch))
    })?
}

/// Calls `act` with the simulation of a scene from rest that records only its sensors and returns its result; or says why the scene cannot
/// be run.
pub(super) fn staged<T>(
    sector: &ReducedSector,
    wheel: &ModalWheel,
    request: &ResolvedSweep,
    stepping: &Stepping,
    ramp_revolutions: f64,
    act: impl FnOnce(Simulation<'_>) -> T,
) -> Result<T, NotRunnable> {
    let (scene, reduced) = (&request.scene, &*sector.wheel);
    let Stepping { scheme, discretisation: steps, .. } = stepping;
    check_at_speed(&stepping.of(request, wheel, &reduced.contact))?;
    let damping = modal_damping(request);
    let clearance = running_clearance(sector, request, wheel.speed_rad_s)?;
    let casing = clearance.and_then(|clearance| casing(reduced, request, clearance, ramp_revolutions));
    check_table(reduced, casing.as_ref(), steps.per_revolution)?;
    let surroundings =
        Surroundings { contact_nodes: &reduced.contact, sectors: wheel.around(), ramp_revolutions };
    let effects = SceneEffects::of(scene, &surroundings)?;
    let (wheel, sensors) = sensed(sector, wheel, request)?;
    Ok(act(Simulation {
        wheel: &wheel,
        contact_nodes: &reduced.contact,
        damping: damping.as_ref(),
        casing: casing.as_ref(),
        effects: effects.borrow(),
        initial: &[],
        scheme: *scheme,
        sensors: &sensors,
        steps_per_revolution: steps.per_revolution,
        samples_per_revolution: steps.samples,
        revolutions: request.integration.revolutions() as usize,
        repeats: None,
        window_revolutions: request.integration.window_revolutions as usize,
        detail: None,
        states: None,
    }))
}
