//! Time steps and recorded samples of a revolution.

use std::f64::consts::TAU;

use super::error::{AnalysisError, Violation};
use super::model::ReducedSector;
use super::monitor::Monitor;
use super::request::{StepsPerRevolution, SweepRequest};
use crate::dynamics::error::ModelError;
use crate::dynamics::modal_wheel::{ModalWheel, natural_frequencies};
use crate::dynamics::schemes::central_differences::smallest_stable_steps;

/// Steps and samples of a revolution.
pub(super) struct Discretisation {
    /// Smallest stable number of steps.
    pub(super) smallest: u64,
    /// S.
    pub(super) per_revolution: usize,
    /// Recorded samples, a divisor of S.
    pub(super) samples: usize,
}

/// `"auto"` stays this far below the stability limit.
const SAFETY: f64 = 0.8;

/// `"auto"` never steps over more than a tenth of a degree: contact begins and ends within a step.
const LEAST_AUTO_STEPS: f64 = 3600.0;

/// Most steps per revolution, given or chosen.
pub(super) const MOST_STEPS: u32 = 10_000_000;

/// `"auto"` takes this many steps over the half-width of a lobe.
const AUTO_STEPS_PER_WIDTH: f64 = 10.0;

/// Fewer steps over the half-width of a lobe would pass it by.
const LEAST_STEPS_PER_WIDTH: f64 = 2.0;

/// Half-width of the lobes of a scene, rad.
fn lobe_width(request: &SweepRequest) -> Option<f64> {
    Some(request.scene.casing.as_ref()?.lobes.as_ref()?.width_rad)
}

/// The smallest number of steps per revolution that sees the lobes of a scene.
fn least_steps_for_lobes(request: &SweepRequest) -> f64 {
    lobe_width(request).map_or(0.0, |width| (LEAST_STEPS_PER_WIDTH * TAU / width).ceil())
}

/// Samples per revolution for each engine order asked for, so that what aliases onto a line of the spectrum comes
/// from orders at least seven times as high.
const SAMPLES_PER_ORDER: usize = 8;

/// Fewest samples a revolution, for the settling verdict.
const LEAST_SAMPLES: usize = 128;

impl Discretisation {
    /// Resolves `steps_per_revolution` for `wheel`; the error says what to change.
    pub(super) fn choose(wheel: &ModalWheel, request: &SweepRequest) -> Result<Self, String> {
        let smallest = smallest_stable_steps(wheel.largest_frequency(), wheel.speed_rad_s);
        let wanted = wanted_samples(request);
        match request.integration.steps_per_revolution {
            StepsPerRevolution::Auto => {
                let lobes = lobe_width(request).map_or(0.0, |width| AUTO_STEPS_PER_WIDTH * TAU / width);
                let least = (smallest as f64 / SAFETY).max(LEAST_AUTO_STEPS).max(lobes).ceil();
                if least > f64::from(MOST_STEPS) {
                    return Err(format!(
                        "this speed would need {least:.1e} steps per revolution, more than {MOST_STEPS}: it is too slow \
                         for the highest frequency of the reduced wheel, or the lobes are too narrow"
                    ));
                }
                let least = least as usize;
                // S = decimation · samples, both whole; samples a multiple of N share the casing table.
                let decimation = (least / wanted).max(1);
                let samples = least.div_ceil(decimation).next_multiple_of(wheel.sectors);
                Ok(Self { smallest, per_revolution: decimation * samples, samples })
            }
            StepsPerRevolution::Fixed(steps) if u64::from(steps) < smallest => Err(format!(
                "{steps} steps per revolution are unstable at this speed; at least {smallest} are needed"
            )),
            StepsPerRevolution::Fixed(steps) => {
                let steps = steps as usize;
                Ok(Self { smallest, per_revolution: steps, samples: samples_of(steps, wanted) })
            }
        }
    }
}

fn wanted_samples(request: &SweepRequest) -> usize {
    LEAST_SAMPLES.max(SAMPLES_PER_ORDER * request.max_engine_order as usize)
}

/// The smallest divisor of `steps` that is at least `wanted`; `steps` itself if there is none.
fn samples_of(steps: usize, wanted: usize) -> usize {
    (wanted..=steps / 2).find(|samples| steps.is_multiple_of(*samples)).unwrap_or(steps)
}

/// Upper bound of the samples a revolution of this request records at any speed, on `sectors` sectors.
pub(super) fn most_samples(request: &SweepRequest, sectors: usize) -> usize {
    let wanted = wanted_samples(request);
    match request.integration.steps_per_revolution {
        StepsPerRevolution::Auto => 2 * wanted + sectors,
        StepsPerRevolution::Fixed(steps) => samples_of(steps as usize, wanted),
    }
}

/// Checks what only the reduced sector can tell, before any speed runs: a fixed step against the stability limit at
/// every speed of the sweep, and against the width of the lobes. Speeds at which the model itself fails are left to their own run.
pub fn check(
    reduced: &ReducedSector,
    request: &SweepRequest,
    monitor: &dyn Monitor,
) -> Result<(), AnalysisError> {
    let StepsPerRevolution::Fixed(steps) = request.integration.steps_per_revolution else { return Ok(()) };
    let speeds = request.speeds.resolve().map_err(AnalysisError::Refused)?;
    let mut worst = (0, 0.0);
    for (index, &speed) in speeds.iter().enumerate() {
        monitor.progress(index as f64 / speeds.len() as f64, "stability limit of the time step");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        let frequencies = reduced
            .wheel
            .harmonics
            .iter()
            .map(|h| natural_frequencies(h, speed, request.scene.centrifugal_stiffening))
            .collect::<Result<Vec<_>, ModelError>>();
        let Ok(frequencies) = frequencies else { continue };
        let largest = frequencies.iter().filter_map(|f| f.last()).fold(0.0f64, |m, &f| m.max(f));
        let smallest_steps = smallest_stable_steps(largest, speed);
        if smallest_steps > worst.0 {
            worst = (smallest_steps, speed);
        }
    }
    let (stable, speed) = worst;
    let seen = least_steps_for_lobes(request) as u64;
    let smallest = stable.max(seen);
    if u64::from(steps) >= smallest {
        return Ok(());
    }
    let reason = if stable >= seen {
        format!(
            "are unstable: central differences need h < 2/ω_max of the reduced wheel, which at {speed:.6} rad/s is met \
             from {stable} steps per revolution on"
        )
    } else {
        format!("pass the lobes by, which are seen from {seen} steps per revolution on")
    };
    Err(AnalysisError::Refused(vec![Violation::new(
        "/integration/steps_per_revolution",
        format!("{steps} steps per revolution {reason}; give at least {smallest}, or \"auto\""),
    )]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_divide_the_steps() {
        assert_eq!(samples_of(6000, 192), 200);
        assert_eq!(samples_of(10007, 192), 10007);
        assert_eq!(samples_of(100, 192), 100);
    }
}
