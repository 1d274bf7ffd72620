//! What the program asks of an effect.

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

/// An effect that a scene may name. Nothing has a default: whoever adds one answers all of it.
pub(crate) struct Effect {
    /// Its field in the scene.
    pub(crate) name: &'static str,
    pub(crate) is_on: fn(&Scene) -> bool,
    /// What it adds to a run that would be without it: its line in plans.
    pub(crate) adds: &'static str,
    pub(crate) acts: Acts,
    pub(crate) repeats: Repeats,
    pub(crate) chain: Chain,
    pub(crate) check: Check,
    /// Steps per revolution that `"auto"` gives it.
    pub(crate) steps: Option<fn(&Scene) -> WantedSteps>,
    /// What the reduced wheel must stand at every speed.
    pub(crate) at_speed: Option<AtSpeed>,
    /// From the scene to the effects of a simulation; none for what is a matter of its own there, as damping is, or needs nothing.
    pub(crate) convert: Option<fn(&Scene, &Surroundings<'_>) -> Converted>,
    /// What it costs beyond what all effects cost that act where it does: of each of its kinds.
    pub(crate) price: Option<&'static [Price]>,
    /// Writes what it did into the result of a speed whose scene names it.
    pub(crate) record: Option<fn(&mut Point, &Ran<'_>)>,
}

/// Where an effect acts in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Acts {
    /// Nowhere, or in the step of every scene.
    Elsewhere,
    /// At the contact, which the scene must have.
    AtContact,
    /// On the modes, which are then driven by other forces than those of contact.
    OnModes,
}

/// How often an effect repeats around the wheel.
pub(crate) enum Repeats {
    /// In every sector.
    Everywhere,
    /// So often; any multiple of 0.
    Times(fn(&Scene) -> Vec<u32>),
    /// Once: what breaks the symmetry.
    Once(&'static str),
}

/// Whether a speed of a sweep up or down goes on with an effect where its neighbour ended.
pub(crate) enum Chain {
    /// As in one run.
    GoesOn,
    /// What it does begins anew.
    Anew(Break),
    /// It moves by itself, and may stand elsewhere.
    Moves(Break),
}

/// Why a speed cannot go on where its neighbour ended.
pub(crate) struct Break {
    /// What the scene names.
    pub(crate) what: &'static str,
    pub(crate) when: fn(&ResolvedSweep) -> bool,
    pub(crate) why: &'static str,
}

/// Holds the effect's part of a request against the model and the rest of the request.
pub(crate) type CheckOf = fn(&mut Findings, &ResolvedSweep, &ModelFacts);

/// When the effect's part of a request is checked; that decides about the order of refusals.
pub(crate) enum Check {
    /// Before the integration.
    First(CheckOf),
    /// After the integration, when every effect of contact has been found to have one.
    Then(CheckOf),
    /// All is right, or another effect's check looks at it.
    Never,
}

/// So many steps per revolution, and why.
pub(crate) type WantedSteps = (f64, &'static str);

/// What a reduced wheel must stand at a speed, before it runs.
pub(crate) struct AtSpeed {
    /// What to change: a JSON pointer.
    pub(crate) pointer: &'static str,
    pub(crate) check: fn(&AboutToRun<'_>) -> Result<(), NotRunnable>,
}

/// A wheel at a speed, as it is going to be stepped.
pub(crate) struct AboutToRun<'a> {
    pub(crate) request: &'a ResolvedSweep,
    pub(crate) wheel: &'a ModalWheel,
    pub(crate) contact_nodes: &'a [ContactNode],
    pub(crate) scheme: Scheme,
    pub(crate) steps_per_revolution: usize,
}

/// What an effect adds to a step: the calibration measures it for a sample, a plan multiplies.
pub(crate) struct Price {
    /// Its name among all that is measured.
    pub(crate) part: &'static str,
    /// How much of it a scene has that names the effect; 0 of another kind.
    pub(crate) amount: fn(&Scene) -> usize,
    /// What one of that costs grows with.
    pub(crate) grows_with: fn(EffectSize) -> f64,
    /// For the synthetic wheel, of such a size that it keeps touching.
    pub(crate) sample: fn(&Wheel) -> Sample,
    /// Whether it costs the same if something touches.
    pub(crate) same_in_contact: bool,
}

/// An effect that is measured.
pub(crate) struct Sample {
    pub(crate) amount: usize,
    pub(crate) on: SampleOn,
}

/// What the effect that is measured is one of.
pub(crate) enum SampleOn {
    Simulation(Box<dyn Physics>),
    /// Of the wheel itself.
    Wheel(Wheel),
}

/// A run that has ended.
pub(crate) struct Ran<'a> {
    pub(crate) run: &'a Run,
    pub(crate) request: &'a ResolvedSweep,
    /// So many equal parts has the wheel, of which one was run.
    pub(crate) parts: f64,
    /// The scene repeats so often around the wheel that was run.
    pub(crate) repeats: usize,
}
