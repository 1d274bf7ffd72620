//! Abradable coating of the casing.

use crate::effects::effect::{Acts, Break, Chain, Check, Effect, Repeats};

mod check;
pub(crate) mod convert;
mod price;
mod record;
pub mod request;
pub mod result;

pub(crate) const EFFECT: Effect = Effect {
    name: "abradable",
    is_on: |scene| scene.abradable.is_some(),
    adds: "a worn depth for every rod, kept over the run, and another law of contact; steps that jump no rod",
    acts: Acts::AtContact,
    repeats: Repeats::Everywhere,
    chain: Chain::Anew(Break {
        what: "abradable",
        when: |request| request.scene.abradable.is_some(),
        why: "its coating is new at every speed",
    }),
    check: Check::Then(check::check),
    steps: Some(|scene| {
        let rods = scene.abradable.as_ref().map_or(0, |coating| coating.rods_around);
        (f64::from(rods), "no step jumps a rod of the coating")
    }),
    at_speed: None,
    convert: Some(convert::convert),
    price: Some(&[price::PRICE]),
    record: Some(record::record),
};
