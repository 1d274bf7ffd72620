//! Coulomb friction at the contact.

use crate::effects::effect::{Acts, AtSpeed, Chain, Check, Effect, Repeats};

mod check;
mod convert;
mod price;
mod record;
pub mod request;
mod sliding;

pub(crate) const EFFECT: Effect = Effect {
    name: "friction",
    is_on: |scene| scene.friction.is_some(),
    adds: "a tangential force with every normal one, of the law `sliding` along the rotation only (that it opposes the vibration, too, is \
           left out), of `disc` against all sliding; the contact problem is no longer symmetric",
    acts: Acts::AtContact,
    repeats: Repeats::Everywhere,
    chain: Chain::GoesOn,
    check: Check::Then(check::check),
    steps: None,
    at_speed: Some(AtSpeed { pointer: check::AT, check: sliding::check }),
    convert: Some(convert::convert),
    price: Some(price::PRICES),
    record: Some(record::record),
};
