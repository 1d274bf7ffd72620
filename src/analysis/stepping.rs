//! Which scheme steps a speed, with how many steps per revolution, and why.

use std::f64::consts::TAU;

use super::auto_or::AutoOr;
use super::discretisation::Discretisation;
use super::error::{AnalysisError, Violation};
use super::model::ReducedSector;
use super::monitor::Monitor;
use super::request::{Integration, SchemeChoice, SweepRequest};
use super::result::SchemeReport;
use crate::dynamics::error::ModelError;
use crate::dynamics::modal_wheel::{ModalWheel, natural_frequencies};
use crate::dynamics::schemes::{Scheme, central_differences, exact_modal, massless_boundary};
use crate::dynamics::sector::ContactNode;

/// How one speed is stepped.
pub(super) struct Stepping {
    pub(super) scheme: Scheme,
    /// Smallest stable number of steps per revolution.
    pub(super) smallest: u64,
    pub(super) discretisation: Discretisation,
    pub(super) report: SchemeReport,
}

/// `"auto"` stays this far below a stability limit.
const SAFETY: f64 = 0.8;

/// `"auto"` never steps over more than a tenth of a degree of contact: it begins and ends within a step.
const LEAST_AUTO_STEPS: f64 = 3600.0;

/// `"auto"` takes this many steps over the half-width of a lobe.
const AUTO_STEPS_PER_WIDTH: f64 = 10.0;

/// Fewer steps over the half-width of a lobe would pass it by.
const LEAST_STEPS_PER_WIDTH: f64 = 2.0;

/// The scheme `auto` resolves every mode as long as that takes no more than this many times the steps that contact needs.
const PRICE_OF_STIFFNESS: f64 = 10.0;

/// Most steps per revolution, given or chosen.
pub(super) const MOST_STEPS: u32 = 10_000_000;

/// Half-width of the lobes of a scene, rad.
fn lobe_width(request: &SweepRequest) -> Option<f64> {
    Some(request.scene.casing.as_ref()?.lobes.as_ref()?.width_rad)
}

/// The smallest number of steps per revolution that sees the lobes of a scene.
fn least_steps_for_lobes(request: &SweepRequest) -> f64 {
    lobe_width(request).map_or(0.0, |width| (LEAST_STEPS_PER_WIDTH * TAU / width).ceil())
}

/// Steps per revolution that `"auto"` gives contact, and why.
fn steps_for_contact(request: &SweepRequest) -> (f64, &'static str) {
    let lobes = lobe_width(request).map_or(0.0, |width| (AUTO_STEPS_PER_WIDTH * TAU / width).ceil());
    if lobes > LEAST_AUTO_STEPS {
        (lobes, "ten steps over the half-width of a lobe")
    } else {
        (LEAST_AUTO_STEPS, "a tenth of a degree, for contact to begin and end in")
    }
}

/// Steps per revolution from which on no mode follows statically under `exact_modal`.
fn resolving_steps(wheel: &ModalWheel) -> f64 {
    (TAU * wheel.largest_frequency() / (wheel.speed_rad_s * exact_modal::FOLLOWS)).ceil()
}

/// Contact nodes that may touch in this scene.
fn touching<'a>(contact_nodes: &'a [ContactNode], request: &SweepRequest) -> &'a [ContactNode] {
    if request.scene.contact.is_some() { contact_nodes } else { &[] }
}

/// A scheme with the steps it wants, and why.
struct Wish {
    scheme: Scheme,
    least_steps: f64,
    reason: String,
}

impl Stepping {
    /// Resolves scheme and step for `wheel`; the error says what to change.
    pub(super) fn choose(
        wheel: &ModalWheel,
        contact_nodes: &[ContactNode],
        request: &SweepRequest,
    ) -> Result<Self, String> {
        let contact_nodes = touching(contact_nodes, request);
        let Integration { scheme, kept_modes, steps_per_revolution, .. } = request.integration;
        let given = match steps_per_revolution {
            AutoOr::Auto => None,
            AutoOr::Fixed(steps) => Some(f64::from(steps)),
        };
        let wish = match (scheme, kept_modes) {
            (SchemeChoice::Auto, _) => automatic(wheel, contact_nodes, request, given)?,
            (SchemeChoice::CentralDifferences, _) => {
                bounded(Scheme::CentralDifferences, wheel, contact_nodes, request)
            }
            (SchemeChoice::ExactModal, _) => resolved(wheel, request),
            (SchemeChoice::MasslessBoundary, AutoOr::Fixed(kept)) => {
                let scheme = Scheme::MasslessBoundary { kept_modes: kept as usize };
                bounded(scheme, wheel, contact_nodes, request)
            }
            (SchemeChoice::MasslessBoundary, AutoOr::Auto) => carried(wheel, contact_nodes, request, given)?,
        };
        let smallest = wish.scheme.smallest_stable_steps(wheel, contact_nodes);
        if smallest == u64::MAX {
            return Err(no_flexibility(wish.scheme));
        }
        let discretisation = match given {
            Some(steps) if (steps as u64) < smallest => {
                return Err(format!(
                    "{steps} steps per revolution are unstable at this speed; at least {smallest} are needed"
                ));
            }
            Some(steps) => Discretisation::exactly(steps as usize, request),
            None if wish.least_steps > f64::from(MOST_STEPS) => {
                return Err(format!(
                    "this speed would need {:.1e} steps per revolution, more than {MOST_STEPS}: it is too slow for the \
                     highest frequency of the reduced wheel, or the lobes are too narrow",
                    wish.least_steps
                ));
            }
            None => Discretisation::at_least(wish.least_steps as usize, request, wheel.sectors),
        };
        let report = report(&wish, wheel, &discretisation, !contact_nodes.is_empty(), given.is_some());
        Ok(Self { scheme: wish.scheme, smallest, discretisation, report })
    }
}

/// The scheme that resolves every mode if its price is bearable, otherwise the one whose step contact alone sets.
fn automatic(
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    request: &SweepRequest,
    given: Option<f64>,
) -> Result<Wish, String> {
    let exact = resolved(wheel, request);
    let affordable = given.unwrap_or(PRICE_OF_STIFFNESS * steps_for_contact(request).0);
    let stiffest = resolving_steps(wheel);
    if contact_nodes.is_empty() || stiffest <= affordable {
        return Ok(exact);
    }
    let massless = carried(wheel, contact_nodes, request, given)?;
    let reason = format!(
        "resolving the stiffest mode would take {stiffest:.0} steps per revolution; {}",
        massless.reason
    );
    Ok(Wish { reason, ..massless })
}

/// Bounded by a stability limit.
fn bounded(
    scheme: Scheme,
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    request: &SweepRequest,
) -> Wish {
    let (contact, why) = steps_for_contact(request);
    let limit = (scheme.smallest_stable_steps(wheel, contact_nodes) as f64 / SAFETY).ceil();
    if limit > contact {
        let reason = format!("the step is {SAFETY} of the stability limit");
        Wish { scheme, least_steps: limit, reason }
    } else {
        Wish { scheme, least_steps: contact, reason: format!("the step is {why}") }
    }
}

/// `exact_modal` with every mode resolved.
fn resolved(wheel: &ModalWheel, request: &SweepRequest) -> Wish {
    let (contact, why) = steps_for_contact(request);
    let modes = resolving_steps(wheel);
    let (least_steps, reason) = if modes > contact {
        (modes, "every mode is advanced exactly and resolved by the step".to_owned())
    } else {
        (contact, format!("every mode is advanced exactly and resolved; the step is {why}"))
    };
    Wish { scheme: Scheme::ExactModal, least_steps, reason }
}

/// `massless_boundary` with as many modes as the step carries.
fn carried(
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    request: &SweepRequest,
    given: Option<f64>,
) -> Result<Wish, String> {
    let (contact, why) = steps_for_contact(request);
    let steps = given.unwrap_or(contact);
    let kept = massless_boundary::most_kept_modes(wheel, contact_nodes, (SAFETY * steps) as u64);
    let kept_modes = kept.ok_or_else(|| {
        format!("{steps} steps per revolution carry no mode of a boundary without mass: take more steps, or another scheme")
    })?;
    let step = if given.is_some() {
        "that the given step carries".to_owned()
    } else {
        format!("that a step of {why} carries")
    };
    Ok(Wish {
        scheme: Scheme::MasslessBoundary { kept_modes },
        least_steps: steps,
        reason: format!("as many modes are kept as leave the boundary the flexibility {step}"),
    })
}

fn no_flexibility(scheme: Scheme) -> String {
    match scheme {
        Scheme::MasslessBoundary { kept_modes } => format!(
            "with {kept_modes} modes per nodal diameter kept, those left out give the boundary no flexibility: keep fewer, \
             leave kept_modes away, or reduce with more modes_per_speed"
        ),
        Scheme::CentralDifferences | Scheme::ExactModal => "the scheme has no stable step".to_owned(),
    }
}

fn report(
    wish: &Wish,
    wheel: &ModalWheel,
    discretisation: &Discretisation,
    touching: bool,
    given: bool,
) -> SchemeReport {
    let (name, kept_modes) = match wish.scheme {
        Scheme::CentralDifferences => (SchemeChoice::CentralDifferences, None),
        Scheme::ExactModal => (SchemeChoice::ExactModal, None),
        Scheme::MasslessBoundary { kept_modes } => (SchemeChoice::MasslessBoundary, Some(kept_modes as u32)),
    };
    let step_s = TAU / (wheel.speed_rad_s * discretisation.per_revolution as f64);
    let follows = if name == SchemeChoice::ExactModal && touching {
        exact_modal::FOLLOWS / step_s
    } else {
        f64::INFINITY
    };
    let (mut following, mut reach) = (0, f64::INFINITY);
    for harmonic in &wheel.harmonics {
        let integrated = &harmonic.omega[..wish.scheme.integrated_modes(harmonic.omega.len())];
        let resolved = integrated.partition_point(|&omega| omega <= follows);
        let pair = if harmonic.single { 1 } else { 2 };
        following += pair * (integrated.len() - resolved);
        reach = reach.min(resolved.checked_sub(1).map_or(0.0, |last| integrated[last]));
    }
    let reason = if given {
        format!("{} steps per revolution as requested", discretisation.per_revolution)
    } else {
        wish.reason.clone()
    };
    SchemeReport { name, reason, kept_modes, following_modes: following as u32, reach_hz: reach / TAU }
}

/// Checks what only the reduced sector can tell, before any speed runs: a fixed step or number of kept modes against the
/// stability limit at every speed of the sweep, and the step against the width of the lobes. Speeds at which the model
/// itself fails are left to their own run.
pub fn check(
    reduced: &ReducedSector,
    request: &SweepRequest,
    monitor: &dyn Monitor,
) -> Result<(), AnalysisError> {
    let Integration { steps_per_revolution, kept_modes, .. } = request.integration;
    if (steps_per_revolution, kept_modes) == (AutoOr::Auto, AutoOr::Auto) {
        return Ok(());
    }
    let speeds = request.speeds.resolve().map_err(AnalysisError::Refused)?;
    let mut worst = (0, 0.0);
    for (index, &speed) in speeds.iter().enumerate() {
        monitor.progress(index as f64 / speeds.len() as f64, "stability limit of the time step");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        let Ok(smallest) = smallest_stable_steps(reduced, request, speed) else { continue };
        if smallest > worst.0 {
            worst = (smallest, speed);
        }
    }
    refuse(request, worst.0, worst.1)
}

/// The stability limit of what a request fixes, at one speed; 1 where nothing it fixes has one.
fn smallest_stable_steps(
    reduced: &ReducedSector,
    request: &SweepRequest,
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
            Ok(central_differences::smallest_stable_steps(largest, speed_rad_s))
        }
        (SchemeChoice::MasslessBoundary, AutoOr::Fixed(kept)) => {
            let wheel = ModalWheel::at(&reduced.wheel, speed_rad_s, stiffening)?;
            let scheme = Scheme::MasslessBoundary { kept_modes: kept as usize };
            Ok(scheme.smallest_stable_steps(&wheel, touching(&reduced.wheel.contact, request)))
        }
        _ => Ok(1),
    }
}

fn refuse(request: &SweepRequest, stable: u64, speed: f64) -> Result<(), AnalysisError> {
    let refused =
        |pointer: &str, message: String| Err(AnalysisError::Refused(vec![Violation::new(pointer, message)]));
    if let (u64::MAX, AutoOr::Fixed(kept)) = (stable, request.integration.kept_modes) {
        let message = no_flexibility(Scheme::MasslessBoundary { kept_modes: kept as usize });
        return refused("/integration/kept_modes", message);
    }
    let AutoOr::Fixed(steps) = request.integration.steps_per_revolution else { return Ok(()) };
    let seen = least_steps_for_lobes(request) as u64;
    let smallest = stable.max(seen);
    if u64::from(steps) >= smallest {
        return Ok(());
    }
    let reason = if stable >= seen {
        let bound = match request.integration.scheme {
            SchemeChoice::MasslessBoundary => {
                "with its kept modes and every contact held, massless_boundary needs h < 2/ω"
            }
            _ => "central differences need h < 2/ω_max of the reduced wheel",
        };
        format!(
            "are unstable: {bound}, which at {speed:.6} rad/s is met from {stable} steps per revolution on"
        )
    } else {
        format!("pass the lobes by, which are seen from {seen} steps per revolution on")
    };
    refused(
        "/integration/steps_per_revolution",
        format!("{steps} steps per revolution {reason}; give at least {smallest}, or \"auto\""),
    )
}
