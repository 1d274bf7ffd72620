//! State that the wheel starts from.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

mod check;
pub mod request;
pub(crate) mod start;

pub(crate) const EFFECT: Effect = Effect {
    name: "initial",
    is_on: |scene| scene.initial.is_some(),
    adds: "a mode that moves when the run starts; nothing in a step",
    acts: Acts::Elsewhere,
    repeats: Repeats::Times(|scene| scene.initial.iter().map(|mode| mode.nodal_diameter).collect()),
    chain: Chain::GoesOn,
    check: Check::Then(check::check),
    steps: None,
    at_speed: None,
    convert: None,
    price: None,
    record: None,
};
