//! Elastic casing.

use crate::effects::effect::{Acts, Break, Chain, Check, Effect, Repeats};

mod check;
pub(crate) mod convert;
mod price;
mod record;
pub mod request;
pub mod resolved;

pub(crate) const EFFECT: Effect = Effect {
    name: "flexible_casing",
    is_on: |scene| scene.flexible_casing.is_some(),
    adds: "two waves of the casing for every n as further oscillators in the same contact problem",
    acts: Acts::AtContact,
    repeats: Repeats::Everywhere,
    chain: Chain::Anew(Break {
        what: "flexible_casing",
        when: |request| request.scene.flexible_casing.is_some(),
        why: "its casing is at rest when a speed begins",
    }),
    check: Check::Then(check::check),
    steps: None,
    at_speed: None,
    convert: Some(convert::convert),
    price: Some(&[price::PRICE]),
    record: Some(record::record),
};
