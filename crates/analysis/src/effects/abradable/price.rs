//! Price of an abradable coating.

use crate::calibration::wheel::STEPS;
use crate::effects::effect::{Price, Sample, SampleOn};
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingMaterial};

/// Material so hard that it is never worn, and so springy that blades are deep in it.
const MATERIAL: CoatingMaterial = CoatingMaterial { modulus: 1e6, yield_stress: 9e5, hardening: 1e6 };

pub(super) const PRICE: Price = Price {
    part: "abradable",
    amount: |_| 1,
    grows_with: |size| size.gaps() as f64,
    sample: |wheel| {
        let coating = Coating::new(MATERIAL, 2.0, STEPS, wheel.contact_nodes(), wheel.modal().sectors)
            .expect("the constants are those of a coating");
        Sample { amount: 1, on: SampleOn::Simulation(Box::new(coating)) }
    },
    same_in_contact: false,
};
