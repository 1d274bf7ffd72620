//! What a case study asks for: one speed, and what happens there.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::Integration;
use crate::request::record::Recorded;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::SpeedUnit;
use crate::request::sweep::{SweepRequest, default_max_engine_order};

/// One speed with everything recorded over chosen revolutions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CaseStudyRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter; `"auto"` is 20.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// The speed.
    pub speed: CaseSpeed,
    /// Effects of the simulation.
    pub scene: Scene,
    /// Time integration.
    #[serde(default)]
    pub integration: Integration,
    /// Whose displacements and velocities are recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of interest: a revolution has at least eight samples for each, and at least 512.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Over which revolutions is recorded, and what; default: everything over the window.
    #[serde(default)]
    pub record: Recorded,
    /// Whether rows of the reduction's basis lie beside it, as of a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
}

/// A rotational speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CaseSpeed {
    /// Above 0.
    pub value: f64,
    /// Its unit.
    pub unit: SpeedUnit,
}

/// A case study as it is stored: speeds of a sweep, by index, with what is recorded of each. A study of one speed is that of a sweep
/// that has no other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CaseStudySettings {
    /// The sweep.
    pub sweep: SweepRequest,
    /// Indices of its speeds.
    pub speeds: Vec<u32>,
    /// What is recorded.
    pub record: Recorded,
}
