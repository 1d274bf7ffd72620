//! Damping in the terms of the physics.

use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::oscillators::ModalDamping;

/// Damping of a scene.
pub(crate) fn modal_damping(request: &ResolvedSweep) -> Option<ModalDamping> {
    let damping = request.scene.damping.as_ref()?;
    Some(ModalDamping { modal_ratio: damping.modal_ratio, family_ratios: damping.family_ratios.clone() })
}
