//! An orbit, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Orbit of the wheel's axis about the casing's: the gap at angle φ in the fixed frame shrinks by radius·cos(φ − `whirl_ratio`·Ωt − phase), and by as
/// much less as the node's normal is not radial. The orbit grows over the ramp.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Orbit {
    /// Radius of the orbit, length: hundredths of the clearance for a machine in order, more than it in a transient.
    pub radius: f64,
    /// Whirl speed over Ω, −2 to 2: 0 is an eccentric casing, 1 synchronous forward whirl, negative backward whirl. The gaps move;
    /// the inertia forces of the moving axis on the blades are left out.
    #[serde(default)]
    pub whirl_ratio: f64,
    /// Angle of the displaced axis at the start, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

impl Plain for Option<Orbit> {}
