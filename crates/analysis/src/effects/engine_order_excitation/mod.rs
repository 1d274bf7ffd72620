//! Harmonic forces at engine orders.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

mod check;
mod convert;
pub(crate) mod price;
mod record;
pub mod request;

/// Steps that `"auto"` takes over a period of the highest engine order of the forces: their amplitude is then right to two parts in a thousand.
const AUTO_STEPS_PER_PERIOD: f64 = 40.0;

pub(crate) const EFFECT: Effect = Effect {
    name: "engine_order_excitation",
    is_on: |scene| !scene.engine_order_excitation.is_empty(),
    adds: "harmonic forces on the modes in every step",
    acts: Acts::OnModes,
    repeats: Repeats::Times(|scene| scene.engine_order_excitation.iter().map(|force| force.order).collect()),
    chain: Chain::GoesOn,
    check: Check::Then(check::check),
    steps: Some(|scene| {
        let order = scene.engine_order_excitation.iter().map(|force| force.order).max().unwrap_or(0);
        (AUTO_STEPS_PER_PERIOD * f64::from(order), "forty steps fall on a period of the fastest force")
    }),
    at_speed: None,
    convert: Some(convert::convert),
    price: None,
    record: Some(record::record),
};
