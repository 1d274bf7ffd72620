//! Friction in the terms of the physics.

use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::contact::friction::{FrictionError, sliding_directions};
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::{Effects, Friction};
use rubmap_wheel::dynamics::sector::ContactNode;

/// What [`Friction`] borrows.
pub(super) struct Sliding {
    coefficient: f64,
    /// n + μt of every contact node.
    directions: Vec<Direction>,
}

impl Sliding {
    pub(super) fn new(contact_nodes: &[ContactNode], coefficient: f64) -> Result<Self, FrictionError> {
        Ok(Self { coefficient, directions: sliding_directions(contact_nodes, coefficient)? })
    }
}

impl Physics for Sliding {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        effects.friction = Some(Friction { coefficient: self.coefficient, directions: &self.directions });
    }
}

pub(super) fn convert(scene: &Scene, surroundings: &Surroundings<'_>) -> Converted {
    let Some(friction) = &scene.friction else { return Ok(None) };
    let sliding = Sliding::new(surroundings.contact_nodes, friction.coefficient)?;
    Ok(Some(Box::new(sliding)))
}
