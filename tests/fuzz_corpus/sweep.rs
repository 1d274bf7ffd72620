//! Runs any bytes as the body of a sweep request: parsed, resolved, checked, integrated and summarised on a small wheel.
//!
//! A refusal is a fine end. A panic, a violation that points nowhere, a completed speed whose numbers are not sound and a
//! failed one that shows numbers are not.

use std::f64::consts::TAU;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use faer::c64;
use rubmap::analysis::effects::symmetry::request::Symmetry;
use rubmap::analysis::error::{AnalysisError, Violation};
use rubmap::analysis::monitor::{Monitor, Unwatched};
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::analysis::request::{Component, SchemeChoice, SteadyChoice, SweepDirection, SweepRequest};
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::{Point, PointStatus, SpeedResult};
use rubmap::analysis::run::{
    ModelFacts, ReducedSector, check, critical_speeds, interaction_map, map_row, prepare, refine,
    resolve_sweep, run_speed,
};
use rubmap::dynamics::casing::{Lobes, Restriction};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::SectorModel;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::fixtures::{WheelRecipe, gyroscopic, wheel};

/// End of a body: how far it got.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// Body that is no sweep request.
    NotParsed,
    /// Request that was refused, every violation at a pointer into it.
    Refused,
    /// Request for more work than a quick run does.
    TooLong,
    /// Request whose every speed was integrated or failed by name.
    Ran {
        /// Number of speeds that were integrated to the end.
        completed: usize,
    },
}

/// Revolutions that the multipliers of a periodic response take at most.
const MULTIPLIERS: f64 = 200.0;

/// Steps × sensors over all speeds of a request that is still run: some ten milliseconds.
const BUDGET: f64 = 60_000.0;

/// Model of the wheel: enough for pairs and both single nodal diameters, stiffening, and several nodes in contact.
struct Model {
    facts: ModelFacts,
    reduced: ReducedSector,
}

fn model() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(|| {
        let recipe = WheelRecipe { sectors: 6, ..Default::default() };
        let mut sector = wheel(recipe).into_parts();
        sector.gyroscopic = Some(gyroscopic(recipe, 5));
        let sector = SectorModel::new(sector).unwrap();
        let reduced = prepare(&sector, 4, None, &NoCheckpoints, &Unwatched).unwrap();
        Model { facts: ModelFacts::of(&sector), reduced }
    })
}

/// Does with `body` what the service does with the body of a sweep; panics if anything about it is not sound.
pub(crate) fn run(body: &[u8]) -> End {
    let Ok(request) = serde_json::from_slice::<SweepRequest>(body) else { return End::NotParsed };
    let Model { facts, reduced } = model();
    let asked = serde_json::to_value(&request).unwrap();
    let request = match resolve_sweep(request, facts) {
        Ok(request) => request,
        Err(violations) => return refused(&violations, &asked),
    };
    let settings = SweepRequest::from(request.clone());
    survives_json(&settings);
    assert_eq!(resolve_sweep(settings.clone(), facts).as_ref(), Ok(&request), "resolved twice");
    let speeds = request.speeds().rad_s();
    if work(reduced, &settings, speeds) > BUDGET {
        return End::TooLong;
    }
    let watch = Patience::default();
    match check(reduced, &request, &watch) {
        Ok(()) => {}
        Err(AnalysisError::Refused(violations)) => return refused(&violations, &asked),
        Err(error) => panic!("{error}"),
    }
    let mut results = Vec::with_capacity(speeds.len());
    for index in 0..speeds.len() {
        match run_speed(reduced, &request, index, None, &watch) {
            Ok(result) => results.push(result),
            Err(AnalysisError::Cancelled) => return End::TooLong,
            Err(error) => panic!("{error}"),
        }
    }
    for (index, result) in results.iter().enumerate() {
        assert_eq!((result.point.index as usize, result.point.speed_rad_s), (index, speeds[index]));
        sound(result, &settings);
    }
    summaries_survive(&request, &results);
    let completed = results.iter().filter(|result| result.point.status == PointStatus::Completed).count();
    End::Ran { completed }
}

/// Asserts that every violation says something about a place that is in the request.
fn refused(violations: &[Violation], request: &Value) -> End {
    assert!(!violations.is_empty());
    for Violation { pointer, message } in violations {
        assert!(pointer.starts_with('/') && request.pointer(pointer).is_some(), "{pointer}: {message}");
        assert!(!message.is_empty(), "{pointer}");
    }
    End::Refused
}

/// Upper bound of steps × sensors over all speeds; a search reads none.
fn work(reduced: &ReducedSector, request: &SweepRequest, speeds: &[f64]) -> f64 {
    let integration = &request.integration;
    let marched = f64::from(integration.revolutions());
    let searched = match integration.steady {
        SteadyChoice::March => 0.0,
        SteadyChoice::Periodic => 4.0 * marched + MULTIPLIERS,
        SteadyChoice::Auto => 8.0 * marched + MULTIPLIERS,
    };
    let per_step = marched * request.sensors.len() as f64 + searched;
    // A speed costs its eigenvalues at least.
    let mut work = speeds.len() as f64 * 1000.0;
    for &speed in speeds {
        if work > BUDGET {
            break;
        }
        let steps = match integration.steps_per_revolution {
            AutoOr::Fixed(steps) => f64::from(steps),
            AutoOr::Auto => auto_steps(reduced, request, speed),
        };
        work += steps * per_step;
    }
    work
}

/// Upper bound of the steps per revolution that `"auto"` takes.
fn auto_steps(reduced: &ReducedSector, request: &SweepRequest, speed: f64) -> f64 {
    // A speed that cannot be evaluated, or needs more steps than there may be, fails without a step.
    let Ok(wheel) = ModalWheel::at(
        &reduced.wheel,
        speed,
        RotationEffects::stiffening(request.scene.centrifugal_stiffening),
    ) else {
        return 0.0;
    };
    // No scheme takes more than central differences, but for a boundary left with little flexibility.
    let scheme = match request.integration.kept_modes {
        AutoOr::Fixed(kept) => Scheme::MasslessBoundary { kept_modes: kept as usize },
        AutoOr::Auto => Scheme::CentralDifferences,
    };
    let stable = scheme.smallest_stable_steps(&wheel, &reduced.wheel.contact) as f64 / 0.8;
    let seen = request.scene.casing.as_ref().map_or(0.0, |casing| {
        let widths = casing.lobes.iter().map(|lobes| lobes.width_rad);
        let widths = widths.chain(casing.single_lobes.iter().map(|lobe| lobe.width_rad));
        let widths = widths.chain(casing.waves.iter().map(|wave| 0.78 / f64::from(wave.order)));
        63.0 / widths.fold(f64::INFINITY, f64::min)
    });
    let steps = stable.max(seen).max(3600.0);
    if steps > 3e7 { 0.0 } else { steps }
}

/// Watch that ends runs which take longer than [`work`] foresaw.
#[derive(Default)]
struct Patience(AtomicUsize);

impl Monitor for Patience {
    fn progress(&self, _fraction: f64, _phase: &str) {}

    fn is_cancelled(&self) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed) > 1000
    }
}

/// Asserts what a speed may claim: all its credentials if it was integrated to the end, no amplitudes and a reason if not.
fn sound(result: &SpeedResult, request: &SweepRequest) {
    survives_json(result);
    let point = &result.point;
    assert!((0.0..=1.0).contains(&point.contact_share), "{point:?}");
    if point.status != PointStatus::Completed {
        assert!(point.message.as_ref().is_some_and(|message| !message.is_empty()), "{point:?}");
        assert!(
            result.spectra.is_none() && point.responses.is_empty() && point.settling.is_none(),
            "{point:?}"
        );
        return;
    }
    assert!(point.message.is_none() && point.settling.is_some(), "{point:?}");
    let scheme = point.scheme.as_ref().unwrap();
    assert!(
        scheme.name != SchemeChoice::Auto && !scheme.reason.is_empty() && scheme.reach_hz >= 0.0,
        "{point:?}"
    );
    assert_eq!(
        point.steps,
        (revolutions(point, request) * f64::from(point.steps_per_revolution)).round() as u64,
        "{point:?}"
    );
    assert!(point.steps_per_revolution >= point.smallest_stable_steps_per_revolution, "{point:?}");
    assert!(point.contact_impulse.unwrap() >= 0.0 && point.largest_energy.unwrap() >= 0.0, "{point:?}");
    assert!(point.smallest_multiplier.is_none_or(|lambda| lambda >= 0.0), "{point:?}");
    // The bound of a healthy run in docs/reading-results.md; or the round-off of what went through, where that is thousands of times what
    // there was at once.
    let through = point.energy.as_ref().unwrap().damping_loss.abs() / point.largest_energy.unwrap();
    assert!(point.energy_residual.unwrap() <= f64::max(1e-9, 1e-12 * through), "{point:?}");
    // There is work if there was contact, and without other causes only then.
    let (touched, moved) = (point.contact_impulse > Some(0.0), point.largest_energy > Some(0.0));
    let scene = &request.scene;
    let caused = scene.initial.is_some()
        || scene.symmetry == Symmetry::Probe
        || !scene.engine_order_excitation.is_empty();
    assert!(if caused { moved || !touched } else { moved == touched }, "{point:?}");
    // Gaps are sums: some hundred roundings of their terms.
    let terms = length_scale(request).min(radius()) + displacement(point) + pressed(request, point);
    assert!(point.largest_penetration.unwrap() <= 1e-13 * terms, "{terms:e} {point:?}");
    plausible(point, request);
    assert_eq!(result.spectra.as_ref().map(|spectra| spectra.sensors.len()), Some(request.sensors.len()));
}

/// Number of revolutions that a completed speed took, with those of a search; bounded as was asked.
fn revolutions(point: &Point, request: &SweepRequest) -> f64 {
    let integration = &request.integration;
    let searched = point.steady.as_ref().map_or(0.0, |steady| steady.revolutions);
    if point.steady.as_ref().is_some_and(|steady| steady.taken) {
        assert!(point.march.is_none(), "{point:?}");
        return searched + 1.0;
    }
    let Some(march) = &point.march else {
        assert!(matches!(integration.revolutions, AutoOr::Fixed(_)), "{point:?}");
        return searched + f64::from(integration.revolutions());
    };
    assert_eq!(march.reason.is_none(), march.period_revolutions.is_some(), "{point:?}");
    match (march.period_revolutions, march.remaining_change) {
        (Some(period), Some(remaining)) => {
            assert!(remaining <= integration.settled_to, "{point:?}");
            assert!(integration.window_revolutions.is_multiple_of(period), "{point:?}");
            assert!(march.revolutions <= integration.most_revolutions, "{point:?}");
        }
        found => assert_eq!((found, march.revolutions), ((None, None), integration.most_revolutions)),
    }
    searched + f64::from(march.revolutions)
}

/// Displacement below which numbers vanish: squares of less are no normal numbers; the program takes modal displacements below 1e-100 for nothing.
const VANISHED: f64 = 1e-150;

/// Asserts that the measures of one history fit to each other, and stay below the tenth of the radius at which a run ends as diverged.
fn plausible(point: &Point, request: &SweepRequest) {
    assert_eq!(point.responses.len(), request.sensors.len());
    for response in &point.responses {
        // One of n samples deviates from the mean by half the span or more, none by more than the span: to the round-off
        // of the mean.
        let (span, round_off) = (2.0 * response.half_peak_to_peak, 1e-12 * response.mean.abs() + VANISHED);
        let least = 0.5 * span / (point.steps as f64).sqrt();
        assert!(response.rms >= least - round_off && response.rms <= span + round_off, "{response:?}");
        if request.scene.contact.is_some() && response.sensor.component == Some(Component::Normal) {
            assert!(response.mean.abs().max(0.5 * span) <= 0.1 * radius(), "{response:?}");
        }
    }
}

/// Largest radius of a contact node.
fn radius() -> f64 {
    model().reduced.wheel.contact.iter().fold(0.0, |radius, node| radius.max(node.position[0]))
}

/// Largest length of the casing.
fn length_scale(request: &SweepRequest) -> f64 {
    let Some(casing) = &request.scene.casing else { return 0.0 };
    let clearance = &casing.clearance;
    let given = clearance.values.iter().flatten().chain(&clearance.leading).chain(&clearance.trailing);
    let lobes = casing.lobes.as_ref().map_or(0.0, |lobes| {
        let (count, amplitude) = (lobes.count, lobes.amplitude);
        let lobes = Lobes { count, amplitude, width_rad: lobes.width_rad, phase_rad: lobes.phase_rad };
        Restriction::from(lobes).highest(1)
    });
    let others = casing.single_lobes.iter().map(|lobe| lobe.amplitude);
    let others: f64 = others.chain(casing.waves.iter().map(|wave| wave.amplitude)).map(f64::abs).sum();
    let measured = casing.measured.iter().flat_map(|measured| measured.heights.iter().flatten());
    let measured = measured.fold(0.0f64, |most, height| most.max(height.abs()));
    let tilt = casing.tilt.as_ref().map_or(0.0, |tilt| {
        let reach =
            model().reduced.wheel.contact.iter().map(|node| node.position[0] + node.position[2].abs());
        tilt.angle_rad.abs() * (reach.fold(0.0, f64::max) + tilt.about_z.abs())
    });
    let orbit = request.scene.orbit.as_ref().map_or(0.0, |orbit| orbit.radius);
    given.copied().fold(0.0, f64::max) + lobes + others + 2.0 * measured + tilt + orbit
}

/// Largest displacement that a tip, or the casing, may have had. |nᵀu|² ≤ nᵀK⁻¹n · uᵀKu, and no elastic energy is larger than
/// the mechanical one.
fn displacement(point: &Point) -> f64 {
    static FLEXIBILITY: OnceLock<f64> = OnceLock::new();
    let flexibility = FLEXIBILITY.get_or_init(|| {
        let wheel = &model().reduced.wheel;
        let at_rest = ModalWheel::at(wheel, 0.0, RotationEffects::stiffening(false)).unwrap();
        let at = |k: usize| {
            let waves = at_rest.harmonics.iter().map(|harmonic| {
                let along = |m: usize| {
                    let n = wheel.contact[k].normal;
                    (0..3).map(|c| harmonic.contact[(3 * k + c, m)] * n[c]).sum::<c64>().norm_sqr()
                };
                let modes = harmonic.omega.iter().enumerate();
                let sum: f64 = modes.map(|(m, omega)| along(m) / omega.powi(2)).sum();
                sum * if harmonic.single { 1.0 } else { 2.0 } / at_rest.sectors as f64
            });
            waves.sum::<f64>()
        };
        (0..wheel.contact.len()).map(at).fold(0.0, f64::max)
    });
    (2.0 * flexibility * point.largest_energy.unwrap()).sqrt() + point.casing_amplitude.unwrap_or(0.0)
}

/// Displacement by which the forces of one step would move an elastic casing if they did not cancel. A light casing
/// gives way to the difference of forces by which stiff blades press it from all sides, and its gaps are as accurate as
/// that.
fn pressed(request: &SweepRequest, point: &Point) -> f64 {
    let modes = request.scene.flexible_casing.iter().flat_map(|casing| casing.modes.iter().flatten());
    let give: f64 = modes.map(|mode| 1.0 / mode.modal_mass).sum();
    // Σλh of a step is part of that of the run, and moves a mode by (Σλh)·h/m.
    let step_s = TAU / (point.speed_rad_s * f64::from(point.steps_per_revolution));
    give * step_s * point.contact_impulse.unwrap()
}

/// Asserts that maps and critical speeds can be made of whatever ran.
fn summaries_survive(request: &ResolvedSweep, results: &[SpeedResult]) {
    let reduced = &model().reduced;
    for sensor in 0..request.sensors().len() {
        let rows = results.iter().rev().map(|result| {
            let row = result.spectra.as_ref().and_then(|spectra| map_row(spectra, sensor, None));
            (result.point.clone(), row.map(<[f64]>::to_vec))
        });
        let map = interaction_map(request, &reduced.units, rows.collect(), sensor, None);
        assert!(map.points.iter().map(|point| &point.index).is_sorted());
        survives_json(&map);
    }
    let points: Vec<_> = results.iter().map(|result| result.point.clone()).collect();
    for table in critical_speeds(reduced, request, &points, None, &Unwatched).unwrap() {
        survives_json(&table);
    }
    let mut refined = SweepRequest::from(request.clone());
    refined.refine = Some(refined.sweep == SweepDirection::Independent);
    let Some(more) = refine(&ResolvedSweep::stored(refined, 0).unwrap(), &points, &[]) else {
        return;
    };
    let (before, after) = (request.speeds().rad_s(), more.speeds().rad_s());
    assert!(after.len() > before.len() && after.starts_with(before), "{before:?} {after:?}");
    let settings = SweepRequest::from(more.clone());
    assert_eq!(ResolvedSweep::stored(settings.clone(), 1).as_ref(), Ok(&more));
    assert!(resolve_sweep(settings.clone(), &model().facts).is_ok());
    survives_json(&settings);
}

/// Asserts that a value is read back unchanged from its JSON; numbers that are none would come back as null.
fn survives_json<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(value: &T) {
    let text = serde_json::to_string(value).unwrap();
    let read: T = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error} in {text}"));
    assert_eq!(&read, value);
}
