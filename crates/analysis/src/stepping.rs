//! Choice of the time-stepping scheme of a speed and of its steps per revolution, with reasons.

use std::f64::consts::TAU;

use crate::discretisation::Discretisation;
use crate::effects::effect::{AboutToRun, WantedSteps};
use crate::effects::flexible_casing::convert::flexible_casing;
use crate::effects::table::{is_driven, named};
use crate::not_runnable::NotRunnable;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{AutoOr, Integration, SchemeChoice};
use crate::resolved::ResolvedSweep;
use crate::result::SchemeReport;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::{Scheme, central_differences, exact_modal, massless_boundary};
use rubmap_wheel::dynamics::sector::ContactNode;

/// Scheme and steps of one speed.
#[derive(Debug, Clone)]
pub(super) struct Stepping {
    pub(super) scheme: Scheme,
    /// Smallest stable number of steps per revolution.
    pub(super) smallest: u64,
    pub(super) discretisation: Discretisation,
    /// Whether modes too fast for the step follow statically under `exact_modal`.
    pub(super) follow: bool,
    pub(super) report: SchemeReport,
}

/// Least steps per revolution of `"auto"` with contact: a tenth of a degree, since contact begins and ends within a step.
const LEAST_AUTO_STEPS: f64 = 3600.0;

/// Largest ratio of steps at which scheme `auto` resolves every mode: the steps for that over those that contact needs.
const PRICE_OF_STIFFNESS: f64 = 10.0;

/// Multiple of the highest frequency asked for up to which a boundary without mass integrates the modes, if it can.
const REACH: f64 = 2.0;

/// Factor by which `"auto"` stays below a stability limit.
pub(super) const SAFETY: f64 = 0.8;

/// Steps per revolution that `"auto"` takes for contact, with the reason: the most that any effect wants.
pub(super) fn steps_for_contact(request: &ResolvedSweep) -> WantedSteps {
    let least = (LEAST_AUTO_STEPS, "contact begins and ends within a tenth of a degree");
    let wanted = named(&request.scene).filter_map(|effect| effect.steps).map(|steps| steps(&request.scene));
    wanted.fold(least, |most, steps| if steps.0 > most.0 { steps } else { most })
}

/// Least steps per revolution at `speed_rad_s` with which no mode follows statically under `exact_modal`.
fn resolving_steps(wheel: &ModalWheel, speed_rad_s: f64) -> f64 {
    (TAU * wheel.largest_frequency() / (speed_rad_s * exact_modal::FOLLOWS)).ceil()
}

/// Smallest stable steps of the scheme ([`Scheme::smallest_stable_steps`]) for the wheel and, if it is elastic, its casing.
fn smallest_stable_steps(
    scheme: Scheme,
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    request: &ResolvedSweep,
) -> u64 {
    let smallest = scheme.smallest_stable_steps(wheel, contact_nodes);
    match scheme {
        Scheme::CentralDifferences => smallest.max(casing_limit(request, wheel.speed_rad_s)),
        _ => smallest,
    }
}

/// Smallest stable number of steps for the waves of an elastic casing by central differences; 1 if it is rigid.
pub(super) fn casing_limit(request: &ResolvedSweep, speed_rad_s: f64) -> u64 {
    let Some(casing) = &request.scene.flexible_casing else { return 1 };
    let highest = flexible_casing(casing).waves.iter().fold(0.0f64, |most, wave| most.max(wave.omega));
    central_differences::smallest_stable_steps(highest, speed_rad_s)
}

/// Contact nodes that may touch in this scene.
pub(super) fn touching<'a>(contact_nodes: &'a [ContactNode], request: &ResolvedSweep) -> &'a [ContactNode] {
    if request.scene.contact.is_some() { contact_nodes } else { &[] }
}

/// Proposed scheme, with the steps it wants.
struct Proposal {
    scheme: Scheme,
    least_steps: f64,
    why_scheme: String,
    why_steps: String,
}

/// Wheel at a speed, with all that its scheme depends on.
struct Scope<'a> {
    wheel: &'a ModalWheel,
    /// Contact nodes that may touch; empty without contact.
    contact_nodes: &'a [ContactNode],
    request: &'a ResolvedSweep,
    /// Steps per revolution given by the request.
    given: Option<u32>,
    /// Whether anything but contact acts on the modes.
    driven: bool,
    /// Whether modes too fast for the step follow statically under `exact_modal`.
    follow: bool,
}

impl Stepping {
    /// Resolves scheme and step for `wheel`; the error says what to change.
    pub(super) fn choose(
        wheel: &ModalWheel,
        contact_nodes: &[ContactNode],
        request: &ResolvedSweep,
    ) -> Result<Self, NotRunnable> {
        let nodes = touching(contact_nodes, request);
        Self::among(wheel, nodes, request, (is_driven(&request.scene), !nodes.is_empty()))
    }

    /// Resolves scheme and step for a run that is taken in parts, with the Euler force or without; the error says what to change.
    pub(super) fn choose_for_parts(
        wheel: &ModalWheel,
        contact_nodes: &[ContactNode],
        request: &ResolvedSweep,
        euler_force: bool,
    ) -> Result<Self, NotRunnable> {
        let nodes = touching(contact_nodes, request);
        let driven = euler_force || is_driven(&request.scene);
        Self::among(wheel, nodes, request, (driven, driven || !nodes.is_empty()))
    }

    /// Resolves scheme and step of a wheel with these nodes that may touch; `driven`: forces act on its modes, `follow`: its fast modes
    /// follow statically.
    fn among(
        wheel: &ModalWheel,
        contact_nodes: &[ContactNode],
        request: &ResolvedSweep,
        (driven, follow): (bool, bool),
    ) -> Result<Self, NotRunnable> {
        let Integration { scheme, kept_modes, steps_per_revolution, .. } = request.integration;
        let given = match steps_per_revolution {
            AutoOr::Auto => None,
            AutoOr::Fixed(steps) => Some(steps),
        };
        let scope = Scope { wheel, contact_nodes, request, given, driven, follow };
        let proposal = match (scheme, kept_modes) {
            (SchemeChoice::Auto, _) => scope.automatic(),
            (SchemeChoice::CentralDifferences, _) => scope.bounded(Scheme::CentralDifferences),
            (SchemeChoice::ExactModal, _) => scope.exact(),
            (SchemeChoice::MasslessBoundary, AutoOr::Fixed(kept)) => {
                scope.bounded(Scheme::MasslessBoundary { kept_modes: kept as usize })
            }
            (SchemeChoice::MasslessBoundary, AutoOr::Auto) => scope.massless()?,
        };
        scope.settle(proposal)
    }

    /// Wheel with this stepping, as the schemes take it.
    pub(super) fn of<'a>(
        &self,
        request: &'a ResolvedSweep,
        wheel: &'a ModalWheel,
        contact_nodes: &'a [ContactNode],
    ) -> AboutToRun<'a> {
        let steps_per_revolution = self.discretisation.per_revolution;
        AboutToRun { request, wheel, contact_nodes, scheme: self.scheme, steps_per_revolution }
    }
}

impl Scope<'_> {
    /// Proposes to resolve every mode if that is affordable at the slowest speed, so that a sweep keeps to one scheme; otherwise a boundary
    /// without mass.
    fn automatic(&self) -> Proposal {
        let slowest = self.request.speeds.rad_s().iter().copied().fold(self.wheel.speed_rad_s, f64::min);
        let stiffest = resolving_steps(self.wheel, slowest);
        let affordable = self.given.map_or(PRICE_OF_STIFFNESS * steps_for_contact(self.request).0, f64::from);
        let mut proposal = self.exact();
        // An elastic casing has mass where it is touched, and tips that stick have a velocity there.
        let scene = &self.request.scene;
        let massive = scene.flexible_casing.is_some() || scene.has_disc();
        if self.contact_nodes.is_empty() || massive || stiffest <= affordable {
            let resolving = resolving_steps(self.wheel, self.wheel.speed_rad_s);
            let pays = stiffest <= affordable && !self.contact_nodes.is_empty();
            if pays && resolving > proposal.least_steps {
                proposal.least_steps = resolving;
                proposal.why_steps = "the step resolves the stiffest mode".to_owned();
            }
            return proposal;
        }
        let price = format!(
            "resolving the stiffest mode at the slowest speed would take {stiffest:.0} steps per revolution"
        );
        match self.massless() {
            Ok(massless) => Proposal { why_scheme: format!("{price}; {}", massless.why_scheme), ..massless },
            Err(_) => Proposal { why_scheme: format!("{price}; {}", proposal.why_scheme), ..proposal },
        }
    }

    /// Proposes a scheme with a stability limit.
    fn bounded(&self, scheme: Scheme) -> Proposal {
        let (contact, why) = steps_for_contact(self.request);
        let smallest = self.smallest_stable_steps(scheme);
        let limit = (smallest as f64 / SAFETY).ceil();
        let why_scheme = "as requested".to_owned();
        if limit > contact {
            let why_steps = format!("the step is {} of the stability limit", SAFETY);
            Proposal { scheme, least_steps: limit, why_scheme, why_steps }
        } else {
            Proposal { scheme, least_steps: contact, why_scheme, why_steps: set_so_that(why) }
        }
    }

    /// Proposes the exact propagator for every mode.
    fn exact(&self) -> Proposal {
        let why_scheme = if self.driven {
            "every mode is advanced exactly but for the forces on it, which are of second order".to_owned()
        } else {
            "every mode is advanced exactly".to_owned()
        };
        let scheme = Scheme::ExactModal;
        if self.contact_nodes.is_empty() && !self.driven {
            let why_steps = "nothing touches, so that any step is exact".to_owned();
            return Proposal { scheme, least_steps: 1.0, why_scheme, why_steps };
        }
        let (contact, why) = steps_for_contact(self.request);
        let why = if self.contact_nodes.is_empty() { "its forces are resolved" } else { why };
        Proposal { scheme, least_steps: contact, why_scheme, why_steps: set_so_that(why) }
    }

    /// Proposes a boundary without mass, with as many modes as the step for contact carries, but enough for the engine orders asked for.
    fn massless(&self) -> Result<Proposal, NotRunnable> {
        let carried = |steps: f64| {
            massless_boundary::most_kept_modes(self.wheel, self.contact_nodes, (SAFETY * steps) as u64)
        };
        let (contact, why) = steps_for_contact(self.request);
        let steps = self.given.map_or(contact, f64::from);
        let kept = carried(steps);
        let wanted = self.modes_reaching(REACH * self.highest_frequency());
        if let (Some(kept_modes), true) = (kept, self.given.is_some() || kept >= Some(wanted)) {
            return Ok(Proposal {
                scheme: Scheme::MasslessBoundary { kept_modes },
                least_steps: steps,
                why_scheme: "as many modes are kept as the step carries".to_owned(),
                why_steps: set_so_that(why),
            });
        }
        if self.given.is_some() {
            return Err(NotRunnable::NoModeCarried { steps });
        }
        let most_steps = f64::from(MOST_STEPS);
        let most = carried(most_steps).ok_or(NotRunnable::NoModeCarried { steps: most_steps })?;
        let scheme = Scheme::MasslessBoundary { kept_modes: wanted.min(most) };
        let why_scheme = format!("modes are kept up to {REACH} times the highest engine order");
        Ok(Proposal { why_scheme, ..self.bounded(scheme) })
    }

    fn smallest_stable_steps(&self, scheme: Scheme) -> u64 {
        smallest_stable_steps(scheme, self.wheel, self.contact_nodes, self.request)
    }

    /// Frequency of the highest engine order asked for, rad/s.
    fn highest_frequency(&self) -> f64 {
        f64::from(self.request.max_engine_order) * self.wheel.speed_rad_s
    }

    /// Number of modes per nodal diameter that reaches `omega` in every one of them.
    fn modes_reaching(&self, omega: f64) -> usize {
        let below = self.wheel.harmonics.iter().map(|h| h.omega.partition_point(|&mode| mode < omega) + 1);
        below.max().unwrap_or(1)
    }

    /// Steps and report of a proposal, if it is possible.
    fn settle(&self, proposal: Proposal) -> Result<Stepping, NotRunnable> {
        let smallest = self.smallest_stable_steps(proposal.scheme);
        if smallest == u64::MAX {
            return Err(NotRunnable::NoStableStep(proposal.scheme));
        }
        let (discretisation, why_steps) = match self.given {
            Some(steps) if u64::from(steps) < smallest => {
                return Err(NotRunnable::Unstable { steps, smallest });
            }
            Some(steps) => {
                let close = f64::from(steps) * SAFETY < smallest as f64;
                let limit = format!(", closer to the limit of {smallest} than \"auto\" would go");
                let why =
                    format!("{steps} steps per revolution as requested{}", if close { &limit } else { "" });
                (Discretisation::exactly(steps as usize, self.request, self.wheel.around()), why)
            }
            None if proposal.least_steps > f64::from(MOST_STEPS) => {
                return Err(NotRunnable::TooManySteps { steps: proposal.least_steps });
            }
            None => {
                let steps = proposal.least_steps as usize;
                (Discretisation::at_least(steps, self.request, self.wheel.around()), proposal.why_steps)
            }
        };
        let reason = format!("{}; {why_steps}", proposal.why_scheme);
        let report = self.report(proposal.scheme, &discretisation, reason);
        Ok(Stepping { scheme: proposal.scheme, smallest, discretisation, follow: self.follow, report })
    }

    fn report(&self, scheme: Scheme, discretisation: &Discretisation, mut reason: String) -> SchemeReport {
        let (name, kept_modes) = match scheme {
            Scheme::CentralDifferences => (SchemeChoice::CentralDifferences, None),
            Scheme::ExactModal => (SchemeChoice::ExactModal, None),
            Scheme::MasslessBoundary { kept_modes } => {
                (SchemeChoice::MasslessBoundary, Some(kept_modes as u32))
            }
        };
        let step_s = TAU / (self.wheel.speed_rad_s * discretisation.per_revolution as f64);
        let follows = match scheme {
            Scheme::ExactModal if self.follow => exact_modal::FOLLOWS / step_s,
            _ => f64::INFINITY,
        };
        let (mut following, mut reach) = (0, f64::INFINITY);
        for harmonic in &self.wheel.harmonics {
            let integrated = &harmonic.omega[..scheme.integrated_modes(harmonic.omega.len())];
            let resolved = integrated.partition_point(|&omega| omega <= follows);
            let pair = if harmonic.single { 1 } else { 2 };
            following += pair * (integrated.len() - resolved);
            reach = reach.min(resolved.checked_sub(1).map_or(0.0, |last| integrated[last]));
        }
        if reach < self.highest_frequency() {
            let order = reach / self.wheel.speed_rad_s;
            reason.push_str(&format!("; beyond engine order {order:.1} the response is static"));
        }
        SchemeReport { name, reason, kept_modes, following_modes: following as u32, reach_hz: reach / TAU }
    }
}

fn set_so_that(why: &str) -> String {
    format!("the step is set so that {why}")
}
