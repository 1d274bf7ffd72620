//! What a probe of the symmetry asks of a simulation.

use super::request::Symmetry;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;

/// The energies of the nodal diameters tell what grows.
struct Energies;

impl Physics for Energies {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.energies = true;
    }
}

pub(super) fn convert(scene: &Scene, _: &Surroundings<'_>) -> Converted {
    Ok((scene.symmetry == Symmetry::Probe).then(|| Box::new(Energies) as Box<dyn Physics>))
}
