//! Knobs of one run.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::SchemeChoice;

/// Knobs that accuracy and time depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Setting {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// Time-stepping scheme.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates.
    pub kept_modes: AutoOr,
    /// Time steps per revolution.
    pub steps_per_revolution: u32,
}
