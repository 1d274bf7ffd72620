//! Effects in the terms of the physics.

use crate::not_runnable::NotRunnable;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::sector::ContactNode;

/// An effect as a simulation takes it.
pub(crate) trait Physics {
    /// Takes its place among the others.
    fn join<'a>(&'a self, effects: &mut Effects<'a>);
}

/// Around what an effect is set up.
pub(crate) struct Surroundings<'a> {
    pub(crate) contact_nodes: &'a [ContactNode],
    /// Of the whole wheel.
    pub(crate) sectors: usize,
    pub(crate) ramp_revolutions: f64,
}

/// What a scene's part comes to; none of what it does not name.
pub(crate) type Converted = Result<Option<Box<dyn Physics>>, NotRunnable>;
