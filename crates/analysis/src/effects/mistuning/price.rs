//! Price of mistuning.

use super::convert::Deviations;
use crate::effects::effect::{Price, Sample, SampleOn};
use rubmap_wheel::dynamics::mistuning::normal_deviations;

pub(super) const PRICE: Price = Price {
    part: "mistuning",
    amount: |_| 1,
    grows_with: |size| (size.step.sectors * size.step.unknowns) as f64,
    sample: |wheel| {
        let deviations = Deviations(normal_deviations(0.02, 1, wheel.modal().sectors));
        Sample { amount: 1, on: SampleOn::Simulation(Box::new(deviations)) }
    },
    same_in_contact: true,
};
