//! Blades that bend far.

use crate::effects::effect::{Acts, Chain, Check, Effect, Repeats};

pub(crate) mod check;
mod convert;
mod price;
mod record;
pub mod request;

pub(crate) const EFFECT: Effect = Effect {
    name: "geometric_nonlinearity",
    is_on: |scene| scene.geometric_nonlinearity.is_some(),
    adds: "displacement of second order at every gap and along every contact force, in a few coordinates of every blade that are read in \
           every step; with `full` forces of blades that stiffen as well",
    acts: Acts::OnModes,
    repeats: Repeats::Everywhere,
    chain: Chain::GoesOn,
    check: Check::Then(check::check),
    steps: None,
    at_speed: None,
    convert: Some(convert::convert),
    price: Some(&[price::KINEMATICS, price::STIFFENING]),
    record: Some(record::record),
};
