//! Prices of friction, by either law.

use super::convert::Rubbing;
use super::request::{Friction, FrictionLaw};
use crate::calibration::wheel::Wheel;
use crate::effects::effect::{Price, Sample, SampleOn};
use crate::resolved::Scene;

const COEFFICIENT: f64 = 0.05;

pub(super) const PRICES: &[Price] = &[
    Price {
        part: "friction",
        amount: |scene| amount(scene, FrictionLaw::Sliding),
        grows_with: |size| size.gaps() as f64,
        sample: |wheel| sample(wheel, FrictionLaw::Sliding),
        same_in_contact: false,
    },
    Price {
        part: "friction_disc",
        amount: |scene| amount(scene, FrictionLaw::Disc),
        grows_with: |size| size.gaps() as f64,
        sample: |wheel| sample(wheel, FrictionLaw::Disc),
        same_in_contact: false,
    },
];

fn amount(scene: &Scene, law: FrictionLaw) -> usize {
    usize::from(scene.friction.as_ref().is_some_and(|friction| friction.law == law))
}

fn sample(wheel: &Wheel, law: FrictionLaw) -> Sample {
    let friction = Friction { coefficient: COEFFICIENT, law };
    let rubbing = Rubbing::new(wheel.contact_nodes(), &friction).expect("tips that face outwards slide");
    Sample { amount: 1, on: SampleOn::Simulation(Box::new(rubbing)) }
}
