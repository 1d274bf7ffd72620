//! The steady response of a speed: marched to, or solved for.

use crate::effects::symmetry::request::Symmetry;
use crate::request::{Integration, SteadyChoice};
use crate::resolved::ResolvedSweep;
use crate::result::{FloquetMultiplier, Stability, SteadyReport};
use rubmap_wheel::dynamics::integrate::{Outcome, Run, Simulation};
use rubmap_wheel::dynamics::steady::multipliers::{MOST_PRODUCTS, Multiplier};
use rubmap_wheel::dynamics::steady::periodic::NotFound;
use rubmap_wheel::dynamics::steady::response::{LEAST_REVOLUTIONS, Response, Sought, record, seek};
use rubmap_wheel::dynamics::steady::stability::Floquet;

/// Most revolutions of a search, and of the march that controls it, as a multiple of those that are asked for.
const LIMIT: u32 = 4;

/// Fewest and most revolutions that a speed takes.
pub(super) fn revolutions_taken(request: &ResolvedSweep) -> [u64; 2] {
    let Integration { revolutions, ramp_revolutions, steady, .. } = request.integration;
    let (marched, limit) = (u64::from(revolutions), u64::from(LIMIT * revolutions));
    let lobes = request.scene.touched_lobes().map_or(1, |lobes| u64::from(lobes.count.max(1)));
    // Each product is of a lobe.
    let multipliers = MOST_PRODUCTS as u64 / lobes;
    let least = ramp_revolutions.ceil() as u64 + LEAST_REVOLUTIONS;
    match steady {
        SteadyChoice::March => [marched, marched],
        SteadyChoice::Periodic => [least, limit + multipliers + marched],
        SteadyChoice::Auto => [least, 2 * limit + multipliers + marched],
    }
}

/// A run, and what is known of the periodic response if it was asked for.
pub(super) struct Simulated {
    pub(super) run: Run,
    pub(super) steady: Option<SteadyReport>,
}

/// Runs `simulation` as `request` says.
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
    let limit = (LIMIT * request.integration.revolutions) as usize;
    let go_on = || watch(0.0);
    let Sought { response, revolutions } = seek(simulation, limit, choice == SteadyChoice::Auto, &go_on);
    let response = match response {
        Ok(response) => response,
        Err(reason) => {
            let reason = (reason != NotFound::Cancelled).then(|| reason.to_string());
            return march(simulation, SteadyReport { reason, ..nothing(revolutions) }, watch);
        }
    };
    let run = record(simulation, &response.modes, watch);
    let reason = why_not(choice, &response);
    let report = SteadyReport {
        taken: reason.is_none(),
        reason,
        half_peak_to_peak: half_peak_to_peak(&run),
        ..found(&response, simulation, revolutions)
    };
    if report.taken { Simulated { run, steady: Some(report) } } else { march(simulation, report, watch) }
}

fn march(simulation: &Simulation<'_>, report: SteadyReport, watch: &dyn Fn(f64) -> bool) -> Simulated {
    Simulated { run: simulation.run(watch), steady: Some(report) }
}

/// Why the periodic response is not what the speed tells.
fn why_not(choice: SteadyChoice, response: &Response) -> Option<String> {
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
        half_peak_to_peak: Vec::new(),
        revolutions,
    }
}

fn found(response: &Response, simulation: &Simulation<'_>, revolutions: f64) -> SteadyReport {
    let Response { residual, floquet, .. } = response;
    let lobes = simulation.casing.and_then(|casing| casing.restriction).map_or(1, |found| found.count.max(1));
    let multiplier = |one: &_| multiplier(floquet, one, simulation, lobes as usize);
    SteadyReport {
        residual: Some(*residual),
        stability: Some(floquet.stability),
        multipliers: floquet.multipliers.iter().map(multiplier).collect(),
        lobe_passages: Some(floquet.lobes as u32),
        ..nothing(revolutions)
    }
}

fn multiplier(
    floquet: &Floquet,
    one: &Multiplier,
    simulation: &Simulation<'_>,
    lobes: usize,
) -> FloquetMultiplier {
    let (index, &share) =
        (one.shares.iter().enumerate()).max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or((0, &0.0));
    FloquetMultiplier {
        real: one.value.re,
        imaginary: one.value.im,
        modulus: one.value.norm(),
        residual: one.residual,
        order_offset: floquet.order_offset(one, lobes),
        nodal_diameter: simulation.wheel.harmonics[index].harmonic as u32,
        share,
    }
}

/// Of every sensor over the window.
fn half_peak_to_peak(run: &Run) -> Vec<f64> {
    let Outcome::Completed(history) = &run.outcome else { return Vec::new() };
    let of = |line: &Vec<f64>| {
        let low = line.iter().copied().fold(f64::INFINITY, f64::min);
        0.5 * (line.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low)
    };
    history.displacement.iter().map(of).collect()
}
