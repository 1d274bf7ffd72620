//! Blades that bend far in the terms of the physics.

use std::sync::Arc;

use super::request;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::not_runnable::NotRunnable;
use crate::resolved::Scene;
use rubmap_wheel::dynamics::bending::{Bending, BladeBending};
use rubmap_wheel::dynamics::effects::Effects;

/// Bending of a blade, with the place of its coordinates in the wheel.
pub(super) struct Bent {
    pub(super) blade: Arc<BladeBending>,
    pub(super) first: usize,
    pub(super) stiffens: bool,
}

impl Physics for Bent {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.bending = Some(Bending { blade: &self.blade, first: self.first, stiffens: self.stiffens });
    }
}

pub(super) fn convert(scene: &Scene, surroundings: &Surroundings<'_>) -> Converted {
    let Some(asked) = &scene.geometric_nonlinearity else { return Ok(None) };
    let (blade, first) = surroundings.bending.clone().ok_or(NotRunnable::UnreadBending)?;
    Ok(Some(Box::new(Bent { blade, first, stiffens: asked.include == request::Bending::Full })))
}
