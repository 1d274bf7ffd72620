//! One speed of a sweep: from the reduced sector to spectra with credentials.

use std::time::Instant;

use super::discretisation::Discretisation;
use super::effects::{SceneEffects, direction, initial};
use super::error::AnalysisError;
use super::model::ReducedSector;
use super::monitor::Monitor;
use super::request::{Sensor, SweepRequest};
use super::result::{
    EnergyReport, Point, PointStatus, SensorResponse, SensorSpectrum, SideBands, SpeedResult, SpeedSpectra,
    Verdict, WearReport,
};
use super::run::VERSION;
use super::stepping::Stepping;
use crate::dynamics::casing::{Casing, Restriction, RestrictionTable, clearance_along_chord};
use crate::dynamics::integrate::{
    Divergence, History, MAX_TABLE_VALUES, Outcome, Run, SensorRow, Simulation,
};
use crate::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::reduction::ReducedWheel;
use crate::dynamics::schemes::Scheme;
use crate::numerics::sector_fourier::SectorFourier;
use crate::numerics::spectrum::amplitudes;
use crate::response::settling::judge;
use crate::response::side_bands::side_bands;
use crate::response::spectra::{engine_orders, nodal_diameter_amplitudes};

/// Simulates speed `index` of a sweep. Deterministic; runs on the calling thread. A speed that diverges or cannot be
/// evaluated is a result (with its status), not an error; the only errors are cancellation and a request that was
/// never resolved.
pub fn run_speed(
    reduced: &ReducedSector,
    request: &SweepRequest,
    index: usize,
    monitor: &dyn Monitor,
) -> Result<SpeedResult, AnalysisError> {
    let start = Instant::now();
    let speeds = request.speeds.resolve().map_err(AnalysisError::Refused)?;
    let mut point = empty_point(index, speeds[index]);
    let mut spectra = None;
    let scene = &request.scene;
    let effects = RotationEffects { stiffening: scene.centrifugal_stiffening, coriolis: scene.coriolis };
    match ModalWheel::at(&reduced.wheel, point.speed_rad_s, effects) {
        Err(error) => point.message = Some(error.to_string()),
        Ok(wheel) => match Stepping::choose(&wheel, &reduced.wheel.contact, request) {
            Err(message) => point.message = Some(message),
            Ok(stepping) => {
                let steps = &stepping.discretisation;
                let watch = |fraction: f64| {
                    monitor.progress(fraction, "contact simulation");
                    !monitor.is_cancelled()
                };
                let run = simulate(&reduced.wheel, &wheel, request, stepping.scheme, steps, &watch);
                if run.is_ok() {
                    point.smallest_stable_steps_per_revolution = stepping.smallest as u32;
                    point.steps_per_revolution = steps.per_revolution as u32;
                    point.scheme = Some(stepping.report);
                }
                spectra = record_run(&mut point, run, request, steps, reduced.wheel.sectors)?;
            }
        },
    }
    point.wall_time_s = start.elapsed().as_secs_f64();
    Ok(SpeedResult { point, spectra })
}

fn empty_point(index: usize, speed_rad_s: f64) -> Point {
    Point {
        index: index as u32,
        speed_rad_s,
        status: PointStatus::Failed,
        message: None,
        settling: None,
        scheme: None,
        steps_per_revolution: 0,
        smallest_stable_steps_per_revolution: 0,
        steps: 0,
        contact_share: 0.0,
        contact_impulse: None,
        largest_penetration: None,
        smallest_multiplier: None,
        energy_residual: None,
        energy: None,
        largest_energy: None,
        casing_amplitude: None,
        wear: None,
        responses: Vec::new(),
        wall_time_s: 0.0,
        version: VERSION.to_owned(),
    }
}

fn simulate(
    reduced: &ReducedWheel,
    wheel: &ModalWheel,
    request: &SweepRequest,
    scheme: Scheme,
    steps: &Discretisation,
    watch: &dyn Fn(f64) -> bool,
) -> Result<Run, String> {
    let scene = &request.scene;
    let damping = scene.damping.as_ref().map(|damping| ModalDamping {
        modal_ratio: damping.modal_ratio,
        family_ratios: damping.family_ratios.clone(),
    });
    let casing = casing(reduced, request);
    if casing.as_ref().is_some_and(|casing| casing.restriction.is_some()) {
        let stride = reduced.contact.len().next_multiple_of(8);
        let size = RestrictionTable::size(steps.per_revolution, wheel.sectors, stride);
        if size > MAX_TABLE_VALUES {
            return Err(format!(
                "the casing's table would take {size} values at {} steps per revolution: take fewer steps, a multiple of the \
                 {} sectors, or wider lobes",
                steps.per_revolution, wheel.sectors
            ));
        }
    }
    let effects = SceneEffects::of(request, &reduced.contact, wheel.sectors)?;
    if let Scheme::MasslessBoundary { kept_modes } = scheme
        && let Some(initial) = &scene.initial
        && initial.family as usize > kept_modes
    {
        return Err(format!(
            "the initial mode is the {}th of its nodal diameter, and {kept_modes} are kept: keep more, or take another scheme",
            initial.family
        ));
    }
    let initial = initial(request, wheel)?;
    let sensors: Vec<_> = request.sensors.iter().map(|sensor| sensor_row(reduced, sensor)).collect();
    Ok(Simulation {
        wheel,
        contact_nodes: &reduced.contact,
        damping: damping.as_ref(),
        casing: casing.as_ref(),
        effects: effects.borrow(),
        initial: &initial,
        scheme,
        sensors: &sensors,
        steps_per_revolution: steps.per_revolution,
        samples_per_revolution: steps.samples,
        revolutions: request.integration.revolutions as usize,
        window_revolutions: request.integration.window_revolutions as usize,
    }
    .run(watch))
}

/// The casing of a scene with contact; a casing that nothing touches does not exist for the integration.
fn casing(reduced: &ReducedWheel, request: &SweepRequest) -> Option<Casing> {
    let casing = request.scene.casing.as_ref()?;
    request.scene.contact.as_ref()?;
    let positions: Vec<_> = reduced.contact.iter().map(|node| node.position).collect();
    let given = &casing.clearance;
    let clearance = given.values.clone().unwrap_or_else(|| {
        clearance_along_chord(given.leading.unwrap_or(0.0), given.trailing.unwrap_or(0.0), &positions)
    });
    let restriction = casing.lobes.as_ref().map(|lobes| Restriction {
        count: lobes.count,
        amplitude: lobes.amplitude,
        width_rad: lobes.width_rad,
        phase_rad: lobes.phase_rad,
    });
    Some(Casing { clearance, restriction, ramp_revolutions: request.integration.ramp_revolutions })
}

fn sensor_row(reduced: &ReducedWheel, sensor: &Sensor) -> SensorRow {
    SensorRow {
        direction: direction(&reduced.contact, sensor.contact_node, sensor.component),
        sector: sensor.sector as usize,
    }
}

/// Writes a run's credentials into `point`; returns its spectra if it is complete.
fn record_run(
    point: &mut Point,
    run: Result<Run, String>,
    request: &SweepRequest,
    steps: &Discretisation,
    sectors: usize,
) -> Result<Option<SpeedSpectra>, AnalysisError> {
    let run = match run {
        Ok(run) => run,
        Err(message) => {
            point.message = Some(message);
            return Ok(None);
        }
    };
    point.steps = run.statistics.steps;
    point.contact_share = run.statistics.contact_share();
    // A run that overflowed has sums that are no numbers; JSON has no word for them.
    let finite = |value: f64| value.is_finite().then_some(value);
    point.contact_impulse = finite(run.statistics.contact_impulse);
    point.largest_penetration = finite(run.statistics.largest_penetration);
    point.smallest_multiplier = run.statistics.smallest_multiplier.and_then(finite);
    point.wear = run.coating.as_ref().map(|coating| WearReport {
        removed_volume: coating.removed_volume(),
        deepest: coating.worn_depths().into_iter().flatten().fold(0.0, f64::max),
        plastic_work: coating.plastic_work(),
        reached_metal: coating.reached_metal(),
    });
    point.casing_amplitude = run.statistics.casing_amplitude.and_then(finite);
    point.energy_residual = finite(run.energy.residual());
    point.energy = EnergyReport::of(&run.energy, &request.scene);
    point.largest_energy = finite(run.energy.largest_energy());
    match run.outcome {
        Outcome::Cancelled => Err(AnalysisError::Cancelled),
        Outcome::Diverged(divergence) => {
            point.status = PointStatus::Diverged;
            point.message = Some(describe(&divergence));
            Ok(None)
        }
        Outcome::ContactFailed { revolutions, error } => {
            point.message = Some(format!("after {revolutions:.4} revolutions {error}"));
            Ok(None)
        }
        Outcome::Completed(history) => {
            point.status = PointStatus::Completed;
            let spectra = spectra(&history, request, sectors);
            let window = request.integration.window_revolutions as usize;
            point.responses = responses(&history, request, &spectra, window * steps.samples);
            let mut settling = judge(&history.displacement, steps.samples, window, lobes(request));
            if settling.verdict == Verdict::Aperiodic {
                settling.side_band_spacing = side_band_spacing(&point.responses);
            }
            point.settling = Some(settling);
            Ok(Some(spectra))
        }
    }
}

fn describe(divergence: &Divergence) -> String {
    let Divergence { revolutions, displacement, contact_node, sector, energy_growth } = *divergence;
    let growth = match energy_growth.filter(|growth| growth.is_finite()) {
        Some(growth) => {
            format!("; the energy was {growth:.3e} times that at the end of the last whole revolution")
        }
        None => String::new(),
    };
    if displacement.is_finite() {
        format!(
            "the response grew without bound: after {revolutions:.3} revolutions contact node {contact_node} of sector \
             {sector} had moved by {displacement:.3e}, more than a tenth of the wheel's radius{growth}"
        )
    } else {
        format!(
            "the response grew without bound: numbers overflowed after {revolutions:.3} revolutions{growth}"
        )
    }
}

fn spectra(history: &History, request: &SweepRequest, sectors: usize) -> SpeedSpectra {
    let engine_orders = engine_orders(request.integration.window_revolutions, request.max_engine_order);
    let bins = engine_orders.len();
    let fourier = SectorFourier::new(sectors);
    let sensors = request.sensors.iter().enumerate().map(|(index, &sensor)| {
        let columns = &history.harmonics[index];
        let whole = &history.displacement[index];
        let window = &whole[whole.len() - columns[0].len()..];
        SensorSpectrum {
            sensor,
            amplitude: amplitudes(window, bins),
            nodal_diameters: nodal_diameter_amplitudes(columns, &fourier, bins),
        }
    });
    SpeedSpectra { sensors: sensors.collect(), engine_orders }
}

fn responses(
    history: &History,
    request: &SweepRequest,
    spectra: &SpeedSpectra,
    window_samples: usize,
) -> Vec<SensorResponse> {
    let of = |(index, &sensor): (usize, &Sensor)| {
        let whole = &history.displacement[index];
        let window = &whole[whole.len() - window_samples..];
        let mean = window.iter().sum::<f64>() / window.len() as f64;
        let variance = window.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / window.len() as f64;
        let (low, high) = window
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
        let spectrum = &spectra.sensors[index];
        let bin = largest_bin(&spectrum.amplitude[1..]) + 1;
        let carried: Vec<f64> = spectrum.nodal_diameters.iter().map(|line| line[bin]).collect();
        SensorResponse {
            sensor,
            mean,
            rms: variance.sqrt(),
            half_peak_to_peak: 0.5 * (high - low),
            dominant_engine_order: spectra.engine_orders[bin],
            dominant_nodal_diameter: largest_bin(&carried) as u32,
            side_bands: side_bands(
                window,
                request.integration.window_revolutions as usize,
                request.max_engine_order as usize,
            ),
        }
    };
    request.sensors.iter().enumerate().map(of).collect()
}

/// Lobes that pass a blade in a revolution, if it may touch them.
fn lobes(request: &SweepRequest) -> Option<u32> {
    request.scene.contact.as_ref()?;
    Some(request.scene.casing.as_ref()?.lobes.as_ref()?.count)
}

/// δ of the strongest pair at the sensor with the largest response.
fn side_band_spacing(responses: &[SensorResponse]) -> Option<f64> {
    let loudest = responses.iter().max_by(|a, b| a.rms.total_cmp(&b.rms))?;
    let weaker = |pair: &SideBands| pair.lower.min(pair.upper);
    loudest.side_bands.iter().max_by(|a, b| weaker(a).total_cmp(&weaker(b))).map(|pair| pair.spacing)
}

fn largest_bin(values: &[f64]) -> usize {
    values.iter().enumerate().fold(0, |best, (i, v)| if *v > values[best] { i } else { best })
}
