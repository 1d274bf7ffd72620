//! Unilateral contact between blade tips and casing.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};
use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;

pub mod request;

pub(crate) const EFFECT: Effect = Effect {
    name: "contact",
    is_on: |scene| scene.contact.is_some(),
    adds: "the gaps of all contact nodes in every step, and a complementarity problem in those in which one would close",
    acts: Acts::Elsewhere,
    repeats: Repeats::Everywhere,
    chain: Chain::GoesOn,
    check: Check::First(check),
    steps: None,
    at_speed: None,
    convert: None,
    price: None,
    record: None,
};

fn check(found: &mut Findings, request: &ResolvedSweep, _: &ModelFacts) {
    found.require(
        request.scene.contact.is_none() || request.scene.casing.is_some(),
        "/scene/contact",
        "contact needs a casing to touch: add /scene/casing",
    );
}
