//! Stiffness that grows with speed.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};
use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;

pub(crate) const EFFECT: Effect = Effect {
    name: "centrifugal_stiffening",
    is_on: |scene| scene.centrifugal_stiffening,
    adds: "K(Ω) = K0 + Ω²K1 + Ω⁴K2 in the eigenproblems of every speed; nothing in a step",
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

fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    found.require(
        !request.scene.centrifugal_stiffening || facts.has_stiffening(),
        "/scene/centrifugal_stiffening",
        "the model has a single stiffness matrix, so there is no stiffening to simulate: set this to false, or \
         upload a package with the stiffness at three speeds",
    );
}
