//! An elastic casing in the terms of the physics.

use std::f64::consts::TAU;

use super::request::CasingMode;
use super::resolved::{self, WavesOf};
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::flexible_casing::{CasingWave, FlexibleCasing, Ring};

/// Waves of the casing, of a ring or as given.
pub(crate) fn flexible_casing(casing: &resolved::FlexibleCasing) -> FlexibleCasing {
    let given = |mode: &CasingMode| CasingWave {
        nodal_diameter: mode.nodal_diameter,
        omega: TAU * mode.frequency_hz,
        modal_mass: mode.modal_mass,
    };
    let waves = match &casing.waves {
        WavesOf::Modes(modes) => modes.iter().map(given).collect(),
        WavesOf::Ring(ring) => {
            let section = Ring {
                radius: ring.radius,
                modulus: ring.modulus,
                density: ring.density,
                area: ring.area,
                second_moment: ring.second_moment,
            };
            section.waves(ring.n_max)
        }
    };
    FlexibleCasing { waves, damping_ratio: casing.damping_ratio }
}

impl Physics for FlexibleCasing {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.flexible_casing = Some(self);
    }
}

pub(super) fn convert(scene: &Scene, _: &Surroundings<'_>) -> Converted {
    let casing = scene.flexible_casing.as_ref().map(flexible_casing);
    Ok(casing.map(|casing| Box::new(casing) as Box<dyn Physics>))
}
