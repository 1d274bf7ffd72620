//! What friction costs.

use super::convert::Sliding;
use crate::effects::effect::{Price, Sample, SampleOn};

const COEFFICIENT: f64 = 0.05;

pub(super) const PRICE: Price = Price {
    amount: |_| 1,
    grows_with: |size| size.gaps() as f64,
    sample: |wheel| {
        let sliding =
            Sliding::new(wheel.contact_nodes(), COEFFICIENT).expect("tips that face outwards slide");
        Sample { amount: 1, on: SampleOn::Simulation(Box::new(sliding)) }
    },
    same_in_contact: false,
};
