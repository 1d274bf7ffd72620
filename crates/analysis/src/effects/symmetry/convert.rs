//! Probe of the symmetry in the terms of the physics.

use super::request::Symmetry;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;

/// Request for the energies of the nodal diameters, which show what grows.
struct Energies;

impl Physics for Energies {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.energies = true;
    }
}

pub(super) fn convert(scene: &Scene, _: &Surroundings<'_>) -> Converted {
    Ok((scene.symmetry == Symmetry::Probe).then(|| Box::new(Energies) as Box<dyn Physics>))
}
