//! Part of the wheel that is simulated, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Part of the wheel that is simulated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Symmetry {
    /// Whole wheel.
    #[default]
    Full,
    /// Sub-wheel that the scene repeats; refused where it does not repeat.
    Exact,
    /// Whole wheel, started from a tiny asymmetry; the result says whether and how fast what the symmetry forbids grows.
    Probe,
}

impl Symmetry {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
    pub(crate) fn is_full(&self) -> bool {
        *self == Self::Full
    }
}

impl Plain for Symmetry {}
