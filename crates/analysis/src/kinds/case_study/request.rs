//! Request for a case study: one speed, and what is recorded there.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::Integration;
use crate::request::record::Recorded;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::SpeedUnit;
use crate::request::sweep::{SweepRequest, default_max_engine_order};

/// A case study: one speed with everything recorded over chosen revolutions.
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
    /// Speed to simulate.
    pub speed: CaseSpeed,
    /// Effects of the simulation.
    pub scene: Scene,
    /// Time integration.
    #[serde(default)]
    pub integration: Integration,
    /// Sensors whose displacements and velocities are recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of interest: a revolution has at least eight samples for each, and at least 512.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Revolutions and quantities to record; default: everything over the window.
    #[serde(default)]
    pub record: Recorded,
    /// Whether the rows of the reduction's basis are stored, as in a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
}

/// A rotational speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CaseSpeed {
    /// Value of the speed, above 0.
    pub value: f64,
    /// Unit of the speed.
    pub unit: SpeedUnit,
}

/// A case study as it is stored: speeds of a sweep, by index, with what is recorded of each. A study of one speed has a sweep of no other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CaseStudySettings {
    /// Sweep whose speeds are studied.
    pub sweep: SweepRequest,
    /// Indices of the speeds in the sweep.
    pub speeds: Vec<u32>,
    /// Revolutions and quantities that are recorded.
    pub record: Recorded,
}
