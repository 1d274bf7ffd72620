//! Asymmetry that a probe of the symmetry starts from.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

pub(crate) mod check;
pub mod request;
pub(crate) mod start;

pub(crate) const EFFECT: Effect = Effect {
    name: "probe",
    is_on: |scene| scene.probe.is_some(),
    adds: "size and seed of that asymmetry",
    acts: Acts::Elsewhere,
    repeats: Repeats::Everywhere,
    chain: Chain::GoesOn,
    // The check of the symmetry begins with that of the probe.
    check: Check::Never,
    steps: None,
    at_speed: None,
    convert: None,
    price: None,
    record: None,
};
