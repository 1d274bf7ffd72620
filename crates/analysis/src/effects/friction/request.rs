//! Friction, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Coulomb friction of tips that always slide forwards: their speed is far above that of their vibration. The force on a
/// blade is −λ(n + μt), t being the direction of rotation along the casing.
///
/// Friction may also make the vibration itself unstable (flutter, or a tip that is dragged in slowly); such a response grows and
/// is reported as diverged. Refused at a speed where the wheel would jam within a step, that is where friction presses tips that lean forwards into the casing more
/// than the contact force lifts them off: the message names the contact node and the largest coefficient that passes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coefficient μ, 0 to 1. Metal sliding on metal at tip speed is reported between 0.1 and 0.3; 0 is no friction.
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 1))]
    pub coefficient: f64,
}

impl Plain for Option<Friction> {}
