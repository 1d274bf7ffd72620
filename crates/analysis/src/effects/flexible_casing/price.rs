//! Price of an elastic casing.

use super::convert::flexible_casing;
use crate::calibration::wheel::SPEED;
use crate::effects::effect::{Price, Sample, SampleOn};
use rubmap_wheel::dynamics::flexible_casing::{CasingWave, FlexibleCasing};

const WAVES: usize = 8;

pub(super) const PRICE: Price = Price {
    part: "flexible_casing",
    amount: |scene| scene.flexible_casing.as_ref().map_or(0, |casing| flexible_casing(casing).waves.len()),
    grows_with: |size| size.gaps() as f64,
    sample: |_| {
        let wave = |n: usize| CasingWave {
            nodal_diameter: n as u32,
            omega: SPEED * (4.0 + n as f64),
            modal_mass: 1.0,
        };
        let casing = FlexibleCasing { waves: (0..WAVES).map(wave).collect(), damping_ratio: 0.01 };
        Sample { amount: WAVES, on: SampleOn::Simulation(Box::new(casing)) }
    },
    same_in_contact: false,
};
