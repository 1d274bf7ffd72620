//! Sectors of different stiffness.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

mod check;
mod convert;
mod price;
mod record;
pub mod request;
pub mod resolved;

pub(crate) const EFFECT: Effect = Effect {
    name: "mistuning",
    is_on: |scene| scene.mistuning.is_some(),
    adds: "forces that couple the nodal diameters of every modal family in every step",
    acts: Acts::OnModes,
    repeats: Repeats::Once("sectors of different stiffness"),
    chain: Chain::GoesOn,
    check: Check::Then(check::check),
    steps: None,
    at_speed: None,
    convert: Some(convert::convert),
    price: Some(&[price::PRICE]),
    record: Some(record::record),
};
