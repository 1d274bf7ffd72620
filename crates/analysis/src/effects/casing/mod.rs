//! Casing around the wheel.

use self::shape::Shape;
use crate::effects::effect::{Acts, Break, Chain, Check, Effect, Repeats};
use crate::resolved::ResolvedSweep;

pub(crate) mod check;
pub(crate) mod convert;
pub mod curves;
pub mod measured;
pub mod request;
pub mod resolved;
pub mod result;
pub mod shape;
mod steps;
mod survey;

pub(crate) const EFFECT: Effect = Effect {
    name: "casing",
    is_on: |scene| scene.casing.is_some(),
    adds: "a clearance for every contact node; with lobes or another shape, a table of its height at every step of a revolution",
    acts: Acts::Elsewhere,
    repeats: Repeats::Times(|scene| scene.touched_shape().and_then(Shape::repeats).into_iter().collect()),
    chain: Chain::Moves(Break {
        what: "clearances given cold",
        when: ResolvedSweep::has_cold_clearances,
        why: "tips grow with the speed, so that their clearance would jump: give clearances of the running wheel",
    }),
    check: Check::First(check::check),
    steps: Some(steps::wanted_steps),
    at_speed: None,
    convert: None,
    price: None,
    record: None,
};
