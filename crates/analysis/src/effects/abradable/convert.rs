//! An abradable coating in the terms of the physics.

use super::request::Abradable;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingError, CoatingMaterial};
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Coating of a scene on a wheel of `sectors`.
pub(crate) fn coating(
    scene: &Scene,
    contact_nodes: &[ContactNode],
    sectors: usize,
) -> Result<Option<Coating>, CoatingError> {
    let Some(coating) = &scene.abradable else { return Ok(None) };
    let Abradable { modulus, yield_stress, hardening, thickness, rods_around } = *coating;
    let material = CoatingMaterial { modulus, yield_stress, hardening };
    Coating::new(material, thickness, rods_around as usize, contact_nodes, sectors).map(Some)
}

impl Physics for Coating {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.coating = Some(self);
    }
}

pub(super) fn convert(scene: &Scene, surroundings: &Surroundings<'_>) -> Converted {
    let coating = coating(scene, surroundings.contact_nodes, surroundings.sectors)?;
    Ok(coating.map(|coating| Box::new(coating) as Box<dyn Physics>))
}
