//! Damping in the terms of the physics.

use crate::model::ReducedSector;
use crate::request::families::FamiliesBy;
use crate::resolved::{ResolvedSweep, Scene};
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::oscillators::ModalDamping;

/// Damping ratios of a scene, families being ranks.
pub(crate) fn ratios(scene: &Scene) -> Option<ModalDamping> {
    let damping = scene.damping.as_ref()?;
    let (modal_ratio, family_ratios) = (damping.modal_ratio, damping.family_ratios.clone());
    Some(ModalDamping { modal_ratio, family_ratios, ranks: Vec::new() })
}

/// Damping of a scene at the speed of `wheel`.
pub(crate) fn modal_damping(
    request: &ResolvedSweep,
    sector: &ReducedSector,
    wheel: &ModalWheel,
) -> Result<Option<ModalDamping>, ModelError> {
    let scene = &request.scene;
    let (Some(asked), Some(damping)) = (&scene.damping, ratios(scene)) else { return Ok(None) };
    let count = damping.family_ratios.len();
    if count == 0 || !scene.centrifugal_stiffening || asked.families_by == FamiliesBy::Rank {
        return Ok(Some(damping));
    }
    let ranks = sector.families.ranks(&sector.wheel, wheel, count)?;
    Ok(Some(ModalDamping { ranks, ..damping }))
}
