//! A change of clearances in the terms of the physics.

use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::clearance_change::ClearanceChange;
use rubmap_wheel::dynamics::effects::Effects;

impl Physics for ClearanceChange {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.clearance_change = Some(self);
    }
}

pub(super) fn convert(scene: &Scene, _: &Surroundings<'_>) -> Converted {
    Ok(change(scene).map(|change| Box::new(change) as Box<dyn Physics>))
}

/// Change of clearances of a scene, if it names one.
pub(crate) fn change(scene: &Scene) -> Option<ClearanceChange> {
    let asked = scene.clearance_change.as_ref()?;
    Some(ClearanceChange {
        course: asked.course.iter().map(|point| (point.revolutions, point.change)).collect(),
        along_chord: asked.along_chord.clone(),
    })
}
