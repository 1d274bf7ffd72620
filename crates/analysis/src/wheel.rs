//! Wheel of a scene.

use crate::effects::symmetry::repeats::repeats;
use crate::effects::symmetry::request::Symmetry;
use crate::resolved::Scene;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap_wheel::dynamics::reduction::ReducedWheel;

/// Effects of rotation on the modes of the wheel.
pub(super) fn rotation(scene: &Scene) -> RotationEffects {
    RotationEffects { stiffening: scene.centrifugal_stiffening, coriolis: scene.coriolis }
}

/// Wheel of a scene at a speed, or the part of it that the scene repeats.
pub(super) fn wheel_of(
    scene: &Scene,
    reduced: &ReducedWheel,
    speed_rad_s: f64,
) -> Result<ModalWheel, ModelError> {
    let parts = match scene.symmetry {
        Symmetry::Exact => repeats(scene, reduced.sectors as u32) as usize,
        Symmetry::Full | Symmetry::Probe => 1,
    };
    Ok(ModalWheel::at(reduced, speed_rad_s, rotation(scene))?.part(parts))
}
