//! Checks of a request that need the reduced sector, before any speed runs.

use crate::effects::abradable::convert::coating;
use crate::effects::effect::AtSpeed;
use crate::effects::table::named;
use crate::error::{AnalysisError, Violation};
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::not_runnable::NotRunnable;
use crate::request::{AutoOr, Integration, SchemeChoice};
use crate::resolved::ResolvedSweep;
use crate::stepping::{SAFETY, Stepping, casing_limit, touching};
use crate::wheel::rotation;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects, natural_frequencies};
use rubmap_wheel::dynamics::schemes::{Scheme, central_differences};

/// Checks a request against the reduced sector, before any speed runs: that the wheel slides, and a fixed step or number of kept modes
/// against the stability limit, at the slowest and at the fastest speed. The limit, ω_max/Ω, falls with speed as K/Ω² does where K is
/// linear in Ω². Speeds between, and those at which the model itself fails, are left to their own runs.
pub fn check(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    monitor: &dyn Monitor,
) -> Result<(), AnalysisError> {
    let speeds = request.speeds.ascending();
    let mut ends: Vec<f64> = speeds.first().into_iter().chain(speeds.last()).copied().collect();
    ends.dedup();
    check_at(reduced, request, &ends)?;
    if let Err(error) = coating(&request.scene, &reduced.wheel.contact, reduced.wheel.sectors) {
        return Err(AnalysisError::Refused(vec![Violation::new("/scene/abradable", error.to_string())]));
    }
    let Integration { steps_per_revolution, kept_modes, .. } = request.integration;
    if (steps_per_revolution, kept_modes) == (AutoOr::Auto, AutoOr::Auto) {
        return Ok(());
    }
    let mut worst = (0, 0.0);
    for (index, &speed) in ends.iter().enumerate() {
        monitor.progress(index as f64 / ends.len() as f64, "stability limit of the time step");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        let Ok(smallest) = limit_of_request(reduced, request, speed) else { continue };
        if smallest > worst.0 {
            worst = (smallest, speed);
        }
    }
    refuse(request, worst.0, worst.1)
}

/// Checks at each of `speeds` that the wheel can be run with what the scene names.
fn check_at(reduced: &ReducedSector, request: &ResolvedSweep, speeds: &[f64]) -> Result<(), AnalysisError> {
    let asked: Vec<&AtSpeed> = named(&request.scene).filter_map(|effect| effect.at_speed.as_ref()).collect();
    if asked.is_empty() {
        return Ok(());
    }
    for &speed in speeds {
        let contact = &reduced.wheel.contact;
        let Ok(wheel) = ModalWheel::at(&reduced.wheel, speed, rotation(&request.scene)) else { continue };
        let Ok(stepping) = Stepping::choose(&wheel, contact, request) else { continue };
        let run = stepping.of(request, &wheel, contact);
        for AtSpeed { pointer, check } in &asked {
            if let Err(error) = check(&run) {
                let message = format!("at {speed:.6} rad/s {error}");
                return Err(AnalysisError::Refused(vec![Violation::new(*pointer, message)]));
            }
        }
    }
    Ok(())
}

/// Stability limit of the fixed settings of a request, at one speed, in steps per revolution; 1 where none of them has a limit.
fn limit_of_request(
    reduced: &ReducedSector,
    request: &ResolvedSweep,
    speed_rad_s: f64,
) -> Result<u64, ModelError> {
    let stiffening = request.scene.centrifugal_stiffening;
    match (request.integration.scheme, request.integration.kept_modes) {
        (SchemeChoice::CentralDifferences, _) => {
            let mut largest = 0.0f64;
            for harmonic in &reduced.wheel.harmonics {
                let omega = natural_frequencies(harmonic, speed_rad_s, stiffening)?;
                largest = largest.max(omega.last().copied().unwrap_or(0.0));
            }
            let limit = central_differences::smallest_stable_steps(largest, speed_rad_s);
            Ok(limit.max(casing_limit(request, speed_rad_s)))
        }
        (SchemeChoice::MasslessBoundary, kept_modes) => {
            let effects = RotationEffects::stiffening(stiffening);
            let wheel = ModalWheel::at(&reduced.wheel, speed_rad_s, effects)?;
            let limit = |kept_modes| {
                let scheme = Scheme::MasslessBoundary { kept_modes };
                scheme.smallest_stable_steps(&wheel, touching(&reduced.wheel.contact, request))
            };
            Ok(match kept_modes {
                AutoOr::Fixed(kept) => limit(kept as usize),
                // `"auto"` keeps at least one mode, at its own distance from the limit.
                AutoOr::Auto => (limit(1) as f64 / SAFETY).ceil() as u64,
            })
        }
        _ => Ok(1),
    }
}

fn refuse(request: &ResolvedSweep, stable: u64, speed: f64) -> Result<(), AnalysisError> {
    let refused =
        |pointer: &str, message: String| Err(AnalysisError::Refused(vec![Violation::new(pointer, message)]));
    if let (u64::MAX, SchemeChoice::MasslessBoundary) = (stable, request.integration.scheme) {
        let (pointer, kept_modes) = match request.integration.kept_modes {
            AutoOr::Fixed(kept) => ("/integration/kept_modes", kept as usize),
            AutoOr::Auto => ("/integration/scheme", 1),
        };
        let scheme = Scheme::MasslessBoundary { kept_modes };
        return refused(pointer, NotRunnable::NoStableStep(scheme).to_string());
    }
    let AutoOr::Fixed(steps) = request.integration.steps_per_revolution else { return Ok(()) };
    if u64::from(steps) >= stable {
        return Ok(());
    }
    let bound = match request.integration.scheme {
        SchemeChoice::MasslessBoundary => {
            "massless_boundary needs h < 1/ω_c of the wheel with every contact held"
        }
        _ => "central differences need h < 2/ω_max of the reduced wheel",
    };
    refused(
        "/integration/steps_per_revolution",
        format!(
            "{steps} steps per revolution are unstable: {bound}, which at {speed:.6} rad/s is met from {stable} steps per revolution \
             on; give at least {stable}, or \"auto\""
        ),
    )
}
