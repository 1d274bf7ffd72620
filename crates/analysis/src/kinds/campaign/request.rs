//! Request for a campaign: a scene, numbers of it that vary, and what is asked about the designs.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::Integration;
use crate::request::record::StressRequest;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::Speeds;
use crate::request::sweep::{SweepRequest, default_max_engine_order};

/// A campaign of many designs, each a scene with other numbers, and each over all speeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CampaignRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Id of another model with which every design is also simulated, to be compared with `model`; it must have the same units, and all that is asked
    /// for must be possible with either.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub compared_model: Option<String>,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter; `"auto"` is 20. All designs share the reduction.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// Speeds at which every design is simulated.
    pub speeds: Speeds,
    /// Effects of the simulation, with a number at every place that a parameter changes.
    pub scene: Scene,
    /// Time integration.
    #[serde(default)]
    pub integration: Integration,
    /// Sensors at which the response is recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of interest: a revolution has at least eight samples for each, and at least 512.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Stress, as in a sweep; needs a model with a mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<StressRequest>,
    /// Parameters that vary.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 100))]
    pub parameters: Vec<Parameter>,
    /// Design of experiments: which designs are simulated.
    pub design: Design,
    /// Severity: how bad a design is.
    #[serde(default)]
    pub severity: Severity,
    /// Limit of the severity, in its unit: a design meets the limit where its severity is no more than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Threshold that is asked for: the value of a parameter from which on the limit is met with a probability; needs a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<Threshold>,
    /// Whether the rows of the reduction's basis are stored, as in a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
}

/// Parameter: a number that varies, independently of the others, and what it does to the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Name of the parameter.
    #[cfg_attr(feature = "schema", schema(min_length = 1, max_length = 64))]
    pub name: String,
    /// RFC 6901 pointers to the numbers of the scene that the parameter changes, all alike, such as `/scene/casing/clearance/leading`.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 100))]
    pub at: Vec<String>,
    /// Change that the value makes to these numbers.
    #[serde(default)]
    pub change: Change,
    /// Distribution of the values; a design of kind `list` gives the values themselves.
    #[serde(default)]
    pub distribution: DistributionKind,
    /// Smallest value; for `normal`, where the distribution is cut off, which may be left away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Largest value; for `normal`, where the distribution is cut off, which may be left away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Most probable value, for `triangular`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<f64>,
    /// Mean before the distribution is cut off, for `normal`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Standard deviation before the distribution is cut off, for `normal`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_deviation: Option<f64>,
    /// Values, all equally probable, for `values`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 10_000))]
    pub values: Option<Vec<f64>>,
    /// Number of values in a grid, evenly spaced from `from` to `to`, for `log_uniform` in the logarithm. For `values` and `whole` all values are
    /// taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub levels: Option<u32>,
}

/// Change that the value of a parameter makes to a number of the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Puts the value in the place of the number.
    #[default]
    Set,
    /// Adds the value to the number.
    Add,
    /// Multiplies the number by the value.
    Multiply,
}

/// Distribution of the values of a parameter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum DistributionKind {
    /// Uniform from `from` to `to`.
    #[default]
    Uniform,
    /// Uniform in the logarithm, from `from` to `to`.
    LogUniform,
    /// Normal, cut off at `from` and `to` where they are given.
    Normal,
    /// Triangular from `from` over `mode` to `to`.
    Triangular,
    /// Whole numbers from `from` to `to`, such as seeds of mistuning.
    Whole,
    /// One of `values`, all equally probable.
    Values,
}

/// Design of experiments: which designs of a campaign are simulated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Kind of the design of experiments.
    pub kind: DesignKind,
    /// Size: for `latin_hypercube` and `sobol` the number of designs, for `indices` the number of blocks, each of as many designs as there are
    /// parameters and two more. Powers of 2 serve Sobol points best.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub size: Option<u32>,
    /// Seed of the designs that are drawn; the same seed gives the same designs. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u32>,
    /// Values of all parameters of every design, for `list`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 10_000))]
    pub points: Option<Vec<Vec<f64>>>,
}

/// Kind of a design of experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum DesignKind {
    /// Grid: all combinations of the levels of all parameters; the last parameter changes first.
    Grid,
    /// List of given designs.
    List,
    /// Latin hypercube: every parameter takes every of `size` equally probable ranges once.
    LatinHypercube,
    /// Sobol points, scrambled by the seed.
    Sobol,
    /// Blocks of designs from which first-order and total sensitivity indices are estimated (Saltelli et al., 2010).
    Indices,
}

/// Severity, how bad a design is: the largest value of all speeds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Half the peak-to-peak displacement of the sensor with the largest, in the model's unit of length.
    #[default]
    Amplitude,
    /// Half the peak-to-peak displacement of the tip that moves most, in the model's unit of length.
    Tip,
    /// The largest contact force on one node, a mean over the interval between two samples, in the model's unit of force.
    ContactForce,
    /// Wear at the deepest place of an abradable coating, in the model's unit of length.
    Wear,
    /// The largest von Mises stress, in the model's units.
    Stress,
    /// The largest utilisation: alternating and mean stress over what the material bears, 1 where nothing is left.
    Utilisation,
}

impl Severity {
    /// Name of the severity on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude",
            Self::Tip => "tip",
            Self::ContactForce => "contact_force",
            Self::Wear => "wear",
            Self::Stress => "stress",
            Self::Utilisation => "utilisation",
        }
    }
}

/// Threshold that is asked for: where a parameter meets the limit with a probability, whatever the other parameters are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Threshold {
    /// Name of the parameter.
    #[cfg_attr(feature = "schema", schema(min_length = 1, max_length = 64))]
    pub parameter: String,
    /// Probability with which the limit is to be met at the threshold.
    #[serde(default = "default_probability")]
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0, exclusive_maximum = 1))]
    pub probability: f64,
    /// Accuracy of the threshold, in the unit of the parameter: until it is known to within this, designs are added where it is not decided; default:
    /// none are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// Number of designs that are added before the answer is looked at again.
    #[serde(default = "default_batch")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub batch: u32,
    /// Largest number of designs, those of `design` among them.
    #[serde(default = "default_most_designs")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub most_designs: u32,
}

/// A campaign as it is stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CampaignSettings {
    /// Sweep that is run for every design, with the scene before anything is changed.
    pub sweep: SweepRequest,
    /// Sweep that is run for every design with the model that is compared, if one is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<SweepRequest>,
    /// Parameters that vary.
    pub parameters: Vec<Parameter>,
    /// Design of experiments: which designs are simulated.
    pub design: Design,
    /// Severity: how bad a design is.
    pub severity: Severity,
    /// Limit of the severity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Threshold that is asked for: where a parameter meets the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<Threshold>,
    /// Values of every design, `[design][parameter]`; those of designs that were added come at the end.
    pub designs: Vec<Vec<f64>>,
    /// Number of designs that were added where the answer was undecided.
    #[serde(default)]
    pub added: u32,
}

impl CampaignSettings {
    /// Index of the parameter of this name.
    pub(crate) fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name == name)
    }

    /// Threshold for which designs are added, if any are, and the accuracy asked for.
    pub(crate) fn sought(&self) -> Option<(&Threshold, f64)> {
        let threshold = self.threshold.as_ref()?;
        Some((threshold, threshold.within?))
    }

    /// Largest number of designs, with those that are added.
    pub(crate) fn designs_at_most(&self) -> u32 {
        self.sought().map_or(0, |(threshold, _)| threshold.most_designs).max(self.designs.len() as u32)
    }
}

fn default_probability() -> f64 {
    0.95
}

/// Default size of a batch: half of its designs are spent before the other half can use their results, which a batch of two or three dozen can bear.
fn default_batch() -> u32 {
    32
}

fn default_most_designs() -> u32 {
    1000
}
