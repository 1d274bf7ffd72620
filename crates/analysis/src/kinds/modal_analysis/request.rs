//! Request for a modal analysis.

use serde::{Deserialize, Serialize};

use crate::request::accuracy::{Accuracy, Budget};
use crate::request::auto_or::AutoOr;
use crate::request::families::FamiliesBy;
use crate::request::omit::is_false;
use crate::request::speeds::Speeds;
use crate::request::sweep::default_max_engine_order;

/// Natural frequencies over speed and the linear interaction criterion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct ModalAnalysisRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter. `"auto"` is what `accuracy` or `budget` chooses, without
    /// them 20.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// Modal families to report: frequencies per nodal diameter.
    #[serde(default = "default_families")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub families: u32,
    /// Meaning of a family.
    #[serde(default)]
    pub families_by: FamiliesBy,
    /// Superharmonic numbers n of the linear criterion f = i·n·Ω/2π.
    #[serde(default = "default_superharmonics")]
    #[cfg_attr(feature = "schema", schema(max_items = 16))]
    pub superharmonics: Vec<u32>,
    /// Number of lobes of the casing that can drive the wheel.
    #[serde(default = "default_lobes")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub lobes: u32,
    /// Highest engine order of the driven crossings.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Whether Coriolis forces act, by the package's gyroscopic matrix: waves that travel with and against the rotation then have frequencies of
    /// their own, which cross engine orders in place of those without.
    #[serde(default, skip_serializing_if = "is_false")]
    pub coriolis: bool,
    /// Speeds of the Campbell diagram: every range and list ascends, several are merged.
    pub speeds: Speeds,
    /// Backbone curves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backbones: Option<BackbonesRequest>,
    /// Accuracy to reach, in place of `modes_per_speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Budget of time to keep to, in place of `modes_per_speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// Whether the rows of the reduction's basis are stored, as in a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
}

/// Backbone curves: frequency of free vibration over its amplitude at the highest speed of the analysis, with the bending of second order of
/// `geometric_nonlinearity`. For models with a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct BackbonesRequest {
    /// Number of coordinates of a blade, 1 to 8, as in `geometric_nonlinearity`.
    #[serde(default = "default_coordinates")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 8, default = 4))]
    pub coordinates: u32,
    /// Nodal diameters; all without them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nodal_diameters: Vec<u32>,
    /// Amplitude at which curves end, a length of the model; default twice the thickness of the blade at its tip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_amplitude: Option<f64>,
}

fn default_coordinates() -> u32 {
    4
}

fn default_families() -> u32 {
    2
}

fn default_superharmonics() -> Vec<u32> {
    vec![1, 2, 3]
}

fn default_lobes() -> u32 {
    2
}
