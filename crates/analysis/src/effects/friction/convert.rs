//! Friction in the terms of the physics.

use super::request;
use crate::effects::physics::{Converted, Physics, Surroundings};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::contact::disc::disc_directions;
use rubmap_wheel::dynamics::contact::friction::{FrictionError, sliding_directions};
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::{Effects, Friction, FrictionLaw};
use rubmap_wheel::dynamics::sector::ContactNode;

/// Coefficient, law and directions of friction, which [`Friction`] borrows.
pub(super) struct Rubbing {
    coefficient: f64,
    law: FrictionLaw,
    directions: Vec<Direction>,
}

impl Rubbing {
    pub(super) fn new(
        contact_nodes: &[ContactNode],
        asked: &request::Friction,
    ) -> Result<Self, FrictionError> {
        let coefficient = asked.coefficient;
        let (law, directions) = match asked.law {
            request::FrictionLaw::Sliding => {
                (FrictionLaw::Sliding, sliding_directions(contact_nodes, coefficient)?)
            }
            request::FrictionLaw::Disc => (FrictionLaw::Disc, disc_directions(contact_nodes)?),
        };
        Ok(Self { coefficient, law, directions })
    }
}

impl Physics for Rubbing {
    fn join<'a>(&'a self, effects: &mut Effects<'a>) {
        let Self { coefficient, law, directions } = self;
        effects.friction = Some(Friction { coefficient: *coefficient, law: *law, directions });
    }
}

pub(super) fn convert(scene: &Scene, surroundings: &Surroundings<'_>) -> Converted {
    let Some(friction) = &scene.friction else { return Ok(None) };
    Ok(Some(Box::new(Rubbing::new(surroundings.contact_nodes, friction)?)))
}
