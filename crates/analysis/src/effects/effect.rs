//! Questions that every effect answers.

use crate::calibration::size::EffectSize;
use crate::calibration::wheel::Wheel;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::model::ModelFacts;
use crate::not_runnable::NotRunnable;
use crate::resolve::findings::Findings;
use crate::resolved::{ResolvedSweep, Scene};
use crate::result::Point;
use rubmap_wheel::dynamics::integrate::Run;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Effect that a scene may name. Nothing has a default: whoever adds an effect answers all of it.
pub(crate) struct Effect {
    /// Name of the effect: its field in the scene.
    pub(crate) name: &'static str,
    pub(crate) is_on: fn(&Scene) -> bool,
    /// Description of what the effect adds to a run that would be without it: its line in plans.
    pub(crate) adds: &'static str,
    pub(crate) acts: Acts,
    pub(crate) repeats: Repeats,
    pub(crate) chain: Chain,
    pub(crate) check: Check,
    /// Steps per revolution that `"auto"` gives the effect.
    pub(crate) steps: Option<fn(&Scene) -> WantedSteps>,
    /// Check of the reduced wheel at every speed.
    pub(crate) at_speed: Option<AtSpeed>,
    /// Conversion from the scene to the effects of a simulation; none for effects that are set up apart there, as damping is, or that need nothing.
    pub(crate) convert: Option<fn(&Scene, &Surroundings<'_>) -> Converted>,
    /// Prices of the effect beyond what all effects cost that act where it does, one for each of its kinds.
    pub(crate) price: Option<&'static [Price]>,
    /// Writes the effect's numbers into the result of a speed whose scene names it.
    pub(crate) record: Option<fn(&mut Point, &Ran<'_>)>,
}

/// Place in a step where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Acts {
    /// Acts nowhere, or in the step of every scene.
    Elsewhere,
    /// Acts at the contact, which the scene must have.
    AtContact,
    /// Acts on the modes, which are then driven by other forces than those of contact.
    OnModes,
}

/// How often an effect repeats around the wheel.
pub(crate) enum Repeats {
    /// Repeats in every sector.
    Everywhere,
    /// Repeats as often as each of these numbers says; 0 stands for any multiple.
    Times(fn(&Scene) -> Vec<u32>),
    /// Repeats once only: breaks the symmetry, for the reason given.
    Once(&'static str),
}

/// Whether a speed of a sweep up or down goes on with an effect where its neighbour ended.
pub(crate) enum Chain {
    /// Goes on as in one run.
    GoesOn,
    /// Begins anew at every speed.
    Anew(Break),
    /// Moves by itself, and may stand elsewhere at the next speed.
    Moves(Break),
}

/// Reason for which a speed cannot go on where its neighbour ended.
pub(crate) struct Break {
    /// Part of the scene that is the reason, in words.
    pub(crate) what: &'static str,
    pub(crate) when: fn(&ResolvedSweep) -> bool,
    pub(crate) why: &'static str,
}

/// Holds the effect's part of a request against the model and the rest of the request.
pub(crate) type CheckOf = fn(&mut Findings, &ResolvedSweep, &ModelFacts);

/// Time at which the effect's part of a request is checked, which decides about the order of refusals.
pub(crate) enum Check {
    /// Check before the integration.
    First(CheckOf),
    /// Check after the integration, when every effect of contact has been found to have one.
    Then(CheckOf),
    /// No check: all is right, or another effect's check looks at it.
    Never,
}

/// Number of steps per revolution, and the reason for it.
pub(crate) type WantedSteps = (f64, &'static str);

/// Check of a reduced wheel at a speed, before it runs.
pub(crate) struct AtSpeed {
    /// JSON pointer to the field that must change if the check fails.
    pub(crate) pointer: &'static str,
    pub(crate) check: fn(&AboutToRun<'_>) -> Result<(), NotRunnable>,
}

/// Wheel at a speed, as it is going to be stepped.
pub(crate) struct AboutToRun<'a> {
    pub(crate) request: &'a ResolvedSweep,
    pub(crate) wheel: &'a ModalWheel,
    pub(crate) contact_nodes: &'a [ContactNode],
    pub(crate) scheme: Scheme,
    pub(crate) steps_per_revolution: usize,
}

/// Price of an effect: what it adds to a step. The calibration measures it for a sample, a plan multiplies.
pub(crate) struct Price {
    /// Name of the price among all that is measured.
    pub(crate) part: &'static str,
    /// Amount of the price in a scene that names the effect; 0 for another kind of the effect.
    pub(crate) amount: fn(&Scene) -> usize,
    /// Size with which the cost of one unit of the amount grows.
    pub(crate) grows_with: fn(EffectSize) -> f64,
    /// Sample of the effect for the synthetic wheel, of such a size that the wheel keeps touching.
    pub(crate) sample: fn(&Wheel) -> Sample,
    /// Whether the cost is the same if something touches.
    pub(crate) same_in_contact: bool,
}

/// Sample of an effect, of which the cost is measured.
pub(crate) struct Sample {
    pub(crate) amount: usize,
    pub(crate) on: SampleOn,
}

/// Owner of the effect that is measured: a simulation or the wheel.
pub(crate) enum SampleOn {
    Simulation(Box<dyn Physics>),
    /// Effect of the wheel itself.
    Wheel(Wheel),
}

/// Run that has ended.
pub(crate) struct Ran<'a> {
    pub(crate) run: &'a Run,
    pub(crate) request: &'a ResolvedSweep,
    /// Number of equal parts of the wheel, of which one was run.
    pub(crate) parts: f64,
    /// Number of times that the scene repeats around the wheel that was run.
    pub(crate) repeats: usize,
}
