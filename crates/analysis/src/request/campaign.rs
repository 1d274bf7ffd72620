//! What a campaign asks for: a scene, numbers of it that vary, and what is wanted of the designs.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::Integration;
use crate::request::record::StressRequest;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::Speeds;
use crate::request::sweep::{SweepRequest, default_max_engine_order};

/// Many designs, each a scene with other numbers, and each over all speeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CampaignRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Id of another model that every design is also simulated with, to be compared with `model`; it must have the same units, and all
    /// that is asked for must be possible with either.
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
    /// Where the response is recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of interest: a revolution has at least eight samples for each, and at least 512.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Stress, as of a sweep; needs a model with a mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<StressRequest>,
    /// What varies.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 100))]
    pub parameters: Vec<Parameter>,
    /// Which designs are simulated.
    pub design: Design,
    /// How bad a design is.
    #[serde(default)]
    pub severity: Severity,
    /// A design meets the limit where its severity is no more than this, in the unit of `severity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// The value of a parameter from which on the limit is met with a probability; needs a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<Threshold>,
    /// Whether rows of the reduction's basis lie beside it, as of a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
}

/// A number that varies, independently of the others, and what it does to the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// What it is called.
    #[cfg_attr(feature = "schema", schema(min_length = 1, max_length = 64))]
    pub name: String,
    /// RFC 6901 pointers to the numbers of the scene that it changes, all alike, such as `/scene/casing/clearance/leading`.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 100))]
    pub at: Vec<String>,
    /// How it changes them.
    #[serde(default)]
    pub change: Change,
    /// How its values are distributed; in a list they are what they are.
    #[serde(default)]
    pub distribution: DistributionKind,
    /// Smallest value; of `normal` where it is cut off, which may be left away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Largest value, as `from`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Of `triangular`: the most probable value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<f64>,
    /// Of `normal`: its mean before it is cut off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Of `normal`: its standard deviation before it is cut off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_deviation: Option<f64>,
    /// Of `values`: all of them, equally probable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 10_000))]
    pub values: Option<Vec<f64>>,
    /// Of a grid: how many values it takes, evenly spaced from `from` to `to`, of `log_uniform` in the logarithm. Those of `values` and `whole`
    /// are all taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub levels: Option<u32>,
}

/// What the value of a parameter does to a number of the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Takes its place.
    #[default]
    Set,
    /// Is added to it.
    Add,
    /// Multiplies it.
    Multiply,
}

/// A distribution.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum DistributionKind {
    /// Uniform from `from` to `to`.
    #[default]
    Uniform,
    /// Uniform in the logarithm.
    LogUniform,
    /// Normal, cut off at `from` and `to` where they are given.
    Normal,
    /// Triangular from `from` over `mode` to `to`.
    Triangular,
    /// Whole numbers from `from` to `to`, such as seeds of mistuning.
    Whole,
    /// One of `values`.
    Values,
}

/// Which designs are simulated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// How they are laid out.
    pub kind: DesignKind,
    /// How many: of `latin_hypercube` and `sobol` designs, of `indices` blocks of as many designs as there are parameters and two more.
    /// Powers of 2 serve Sobol points best.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub size: Option<u32>,
    /// Seed of what is drawn; the same seed gives the same designs. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u32>,
    /// Of `list`: the values of all parameters of every design.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 10_000))]
    pub points: Option<Vec<Vec<f64>>>,
}

/// Kind of a design of experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum DesignKind {
    /// All combinations of the levels of all parameters; the last one changes first.
    Grid,
    /// Those given.
    List,
    /// A Latin hypercube: every parameter takes every of `size` equally probable ranges once.
    LatinHypercube,
    /// Sobol points, scrambled by the seed.
    Sobol,
    /// Those from which first-order and total sensitivity indices are estimated (Saltelli et al., 2010).
    Indices,
}

/// How bad a design is: the largest of all speeds.
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
    /// The word on the wire.
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

/// Where a parameter meets the limit with a probability, whatever the others are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Threshold {
    /// Name of the parameter.
    #[cfg_attr(feature = "schema", schema(min_length = 1, max_length = 64))]
    pub parameter: String,
    /// The probability with which the limit is to be met there.
    #[serde(default = "default_probability")]
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0, exclusive_maximum = 1))]
    pub probability: f64,
    /// Until the value is known to within this, in the unit of the parameter, designs are added where it is not decided; default: none are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// How many designs are added before the answer is looked at again.
    #[serde(default = "default_batch")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub batch: u32,
    /// So many designs there are at most, those of `design` among them.
    #[serde(default = "default_most_designs")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub most_designs: u32,
}

/// A campaign as it is stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CampaignSettings {
    /// The sweep that every design is, with the scene before anything is changed.
    pub sweep: SweepRequest,
    /// The same with the model that is compared with it, if one is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<SweepRequest>,
    /// What varies.
    pub parameters: Vec<Parameter>,
    /// Which designs are simulated.
    pub design: Design,
    /// How bad a design is.
    pub severity: Severity,
    /// The limit of the severity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Where a parameter meets it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<Threshold>,
    /// `[design][parameter]`: the values of every design, those that were added at the end.
    pub designs: Vec<Vec<f64>>,
    /// How many of them were added where the answer was undecided.
    #[serde(default)]
    pub added: u32,
}

impl CampaignSettings {
    /// Index of the parameter of this name.
    pub(crate) fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name == name)
    }

    /// The threshold for which designs are added, if any are, and to within what.
    pub(crate) fn sought(&self) -> Option<(&Threshold, f64)> {
        let threshold = self.threshold.as_ref()?;
        Some((threshold, threshold.within?))
    }

    /// How many designs there may come to be, with those that are added.
    pub(crate) fn designs_at_most(&self) -> u32 {
        self.sought().map_or(0, |(threshold, _)| threshold.most_designs).max(self.designs.len() as u32)
    }
}

fn default_probability() -> f64 {
    0.95
}

/// Half the designs of a round are spent before the other half knows of them, which a round of two or three dozen can bear.
fn default_batch() -> u32 {
    32
}

fn default_most_designs() -> u32 {
    1000
}
