//! An orbit in the terms of the physics.

use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::orbit::Orbit;

impl Physics for Orbit {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.orbit = Some(*self);
    }
}

pub(super) fn convert(scene: &Scene, _: &Surroundings<'_>) -> Converted {
    let Some(orbit) = &scene.orbit else { return Ok(None) };
    Ok(Some(Box::new(Orbit {
        radius: orbit.radius,
        whirl_ratio: orbit.whirl_ratio,
        phase_rad: orbit.phase_rad,
    })))
}
