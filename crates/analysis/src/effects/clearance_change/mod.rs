//! Clearances that change while the wheel turns.

use crate::effects::effect::{Acts, Break, Chain, Check, Effect, Repeats};

mod check;
pub(crate) mod convert;
pub mod request;

pub(crate) const EFFECT: Effect = Effect {
    name: "clearance_change",
    is_on: |scene| scene.clearance_change.is_some(),
    adds: "a shift of all gaps that changes over the run",
    acts: Acts::AtContact,
    repeats: Repeats::Everywhere,
    chain: Chain::Anew(Break {
        what: "clearances that change",
        when: |request| request.scene.clearance_change.is_some(),
        why: "they would jump back to where they begin",
    }),
    check: Check::Then(check::check),
    steps: None,
    at_speed: None,
    convert: Some(convert::convert),
    price: None,
    record: None,
};
