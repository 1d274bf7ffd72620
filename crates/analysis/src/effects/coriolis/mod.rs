//! Coriolis forces.

use crate::effects::effect::{Acts, Chain, Check, Effect, Price, Repeats, Sample, SampleOn};

pub(crate) mod check;

pub(crate) const EFFECT: Effect = Effect {
    name: "coriolis",
    is_on: |scene| scene.coriolis,
    adds: "a product with the gyroscopic matrix of every nodal diameter in every step; the contact problem is no longer symmetric",
    acts: Acts::OnModes,
    repeats: Repeats::Everywhere,
    chain: Chain::GoesOn,
    check: Check::First(|found, request, facts| {
        check::check(found, request.scene.coriolis, "/scene/coriolis", facts);
    }),
    steps: None,
    at_speed: None,
    convert: None,
    price: Some(&[Price {
        part: "coriolis",
        amount: |_| 1,
        grows_with: |size| size.squares as f64,
        sample: |wheel| Sample { amount: 1, on: SampleOn::Wheel(wheel.clone().turning()) },
        same_in_contact: false,
    }]),
    record: None,
};
