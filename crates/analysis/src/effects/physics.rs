//! Effects in the terms of the physics.

use std::sync::Arc;

use crate::not_runnable::NotRunnable;
use rubmap_wheel::dynamics::bending::BladeBending;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Effect as a simulation takes it.
pub(crate) trait Physics {
    /// Joins the other effects of a simulation.
    fn join<'a>(&'a self, effects: &mut Effects<'a>);
}

/// Surroundings in which an effect is set up.
pub(crate) struct Surroundings<'a> {
    pub(crate) contact_nodes: &'a [ContactNode],
    /// Number of sectors of the whole wheel.
    pub(crate) sectors: usize,
    pub(crate) ramp_revolutions: f64,
    /// Second-order bending of a blade and the place of its coordinates in the wheel, for blades that bend far.
    pub(crate) bending: Option<(Arc<BladeBending>, usize)>,
}

/// Effect that a field of the scene is converted to; none where the scene does not name it.
pub(crate) type Converted = Result<Option<Box<dyn Physics>>, NotRunnable>;
