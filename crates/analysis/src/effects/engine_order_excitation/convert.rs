//! Forces at engine orders in the terms of the physics.

use crate::component::direction;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;

impl Physics for Vec<EngineOrderExcitation> {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.excitation = self;
    }
}

pub(super) fn convert(scene: &Scene, surroundings: &Surroundings<'_>) -> Converted {
    let Surroundings { contact_nodes, ramp_revolutions, .. } = *surroundings;
    let excitation = scene.engine_order_excitation.iter().map(|excitation| EngineOrderExcitation {
        order: excitation.order,
        directions: (excitation.contact_nodes.iter())
            .map(|&node| direction(contact_nodes, node as usize, excitation.component))
            .collect(),
        amplitude: excitation.amplitude,
        phase_rad: excitation.phase_rad,
        ramp_revolutions,
    });
    Ok(Some(Box::new(excitation.collect::<Vec<_>>())))
}
