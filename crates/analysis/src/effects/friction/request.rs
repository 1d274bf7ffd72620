//! Friction, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Coulomb friction of the tips at the casing, by one of two laws.
///
/// Friction may also make the vibration itself unstable (flutter, or a tip that is dragged in slowly); such a response grows and
/// is reported as diverged. Refused at a speed where the wheel would jam within a step, that is where friction presses tips that lean
/// into their sliding into the casing more than the contact force lifts them off: the message names the contact node and the largest
/// coefficient that passes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coefficient μ, 0 to 1. Metal sliding on metal at tip speed is reported between 0.1 and 0.3; 0 is no friction.
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 1))]
    pub coefficient: f64,
    /// Law by which friction acts.
    #[serde(default, skip_serializing_if = "FrictionLaw::is_sliding")]
    pub law: FrictionLaw,
}

/// Law by which friction acts on a tip.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum FrictionLaw {
    /// Sliding: tips always slide forwards, for their speed is far above that of their vibration. The force on a blade is −λ(n + μt), t being the
    /// direction of rotation along the casing. Cheap. Left out is that the vibration turns the sliding: across the rotation friction opposes it as a
    /// damper of μλ/rΩ would, which can decide whether a lightly damped response settles.
    #[default]
    Sliding,
    /// Disc: Coulomb's disc in the contact plane; tips stick, or slide in any direction, by the velocity of rotation and vibration together. Solved
    /// in every step to round-off. With the schemes `exact_modal` and `central_differences`; not with a coating; speeds are marched
    /// (`integration.steady` says so), and branches cannot be followed.
    Disc,
}

impl FrictionLaw {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
    pub(crate) fn is_sliding(&self) -> bool {
        *self == Self::Sliding
    }
}

impl Plain for Option<Friction> {}
