//! State to start from, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Mode that moves when the run starts: one of the wheel without mistuning and Coriolis forces, which make several waves of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Nodal diameter i.
    pub nodal_diameter: u32,
    /// Modal family within it, counted from 1: the rank of the mode at the speed of the run.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub family: u32,
    /// Largest displacement component of any contact node, length; within the clearances, for blades that stood inside the
    /// casing would be thrown out of it at once.
    pub amplitude: f64,
    /// Wave of the mode: standing, or travelling with or against the rotation (pairs only).
    #[serde(default)]
    pub wave: InitialWave,
}

/// Wave of an initial mode.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum InitialWave {
    /// Standing wave, released at rest from its amplitude.
    #[default]
    Standing,
    /// Wave that travels with the rotation.
    Forward,
    /// Wave that travels against the rotation.
    Backward,
}

impl Plain for Option<Initial> {}
