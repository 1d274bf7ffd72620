//! Modal damping.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

mod check;
pub(crate) mod convert;
pub mod request;

pub(crate) const EFFECT: Effect = Effect {
    name: "damping",
    is_on: |scene| scene.damping.is_some(),
    adds: "a decay in every mode's recursion, and its loss in the energy identity",
    acts: Acts::Elsewhere,
    repeats: Repeats::Everywhere,
    chain: Chain::GoesOn,
    check: Check::First(check::check),
    steps: None,
    at_speed: None,
    convert: None,
    price: None,
    record: None,
};
