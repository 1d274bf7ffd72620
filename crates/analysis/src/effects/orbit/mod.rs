//! An eccentric casing or a whirling shaft.

use crate::effects::effect::{Acts, Break, Chain, Check, Effect, Repeats};
use crate::request::AutoOr;

mod check;
mod convert;
pub(crate) mod price;
pub mod request;

pub(crate) const EFFECT: Effect = Effect {
    name: "orbit",
    is_on: |scene| scene.orbit.is_some(),
    adds: "a shift of every gap that moves with the axis",
    acts: Acts::AtContact,
    repeats: Repeats::Once("an axis off the casing's"),
    chain: Chain::Moves(Break {
        what: "orbit",
        when: |request| {
            // A march that ends by itself may do so after any number of revolutions.
            let revolutions = match request.integration.revolutions {
                AutoOr::Fixed(revolutions) => f64::from(revolutions),
                AutoOr::Auto => 1.0,
            };
            request.scene.orbit.as_ref().is_some_and(|orbit| (orbit.whirl_ratio * revolutions).fract() != 0.0)
        },
        why: "its axis would jump, for whirl_ratio × revolutions is not whole: give a number of revolutions with which it is",
    }),
    check: Check::Then(check::check),
    steps: None,
    at_speed: None,
    convert: Some(convert::convert),
    price: None,
    record: None,
};
