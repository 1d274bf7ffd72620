//! Part of the wheel that is simulated.

use super::effect::{Acts, Break, Chain, Check, Effect, Repeats};
use request::Symmetry;

pub(crate) mod check;
mod convert;
mod record;
pub(crate) mod repeats;
pub mod request;
pub mod result;

pub(crate) const EFFECT: Effect = Effect {
    name: "symmetry",
    is_on: |scene| scene.symmetry != Symmetry::Full,
    adds: "exact: only the nodal diameters that the scene's symmetry lets move; probe: a seeded asymmetry at the start",
    acts: Acts::Elsewhere,
    repeats: Repeats::Everywhere,
    chain: Chain::Anew(Break {
        what: "symmetry: probe",
        when: |request| request.scene.symmetry == Symmetry::Probe,
        why: "its asymmetry is one of the start",
    }),
    // The symmetry is held against all other effects, when each has been checked.
    check: Check::Never,
    steps: None,
    at_speed: None,
    convert: Some(convert::convert),
    price: None,
    record: Some(record::record),
};
