//! The casing around the wheel.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

pub(crate) mod check;
pub(crate) mod convert;
pub mod request;
pub mod resolved;
mod steps;

pub(crate) const EFFECT: Effect = Effect {
    name: "casing",
    is_on: |scene| scene.casing.is_some(),
    adds: "a clearance for every contact node; with lobes, a table of their height at every step of a revolution",
    acts: Acts::Elsewhere,
    repeats: Repeats::Times(|scene| scene.touched_lobes().map(|lobes| lobes.count).into_iter().collect()),
    chain: Chain::GoesOn,
    check: Check::First(check::check),
    steps: Some(steps::wanted_steps),
    at_speed: None,
    convert: None,
    price: None,
    record: None,
};
