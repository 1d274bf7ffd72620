//! Mistuning in the terms of the physics.

use super::resolved::Mistuning;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::mistuning::normal_deviations;

/// Relative stiffness deviation δ of every sector.
pub(super) struct Deviations(pub(super) Vec<f64>);

impl Physics for Deviations {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.mistuning = Some(&self.0);
    }
}

pub(super) fn convert(scene: &Scene, surroundings: &Surroundings<'_>) -> Converted {
    let Some(mistuning) = &scene.mistuning else { return Ok(None) };
    let deviations = match mistuning {
        Mistuning::Given(deviations) => deviations.clone(),
        Mistuning::Drawn { spread, seed } => normal_deviations(*spread, *seed, surroundings.sectors),
    };
    Ok(Some(Box::new(Deviations(deviations))))
}
