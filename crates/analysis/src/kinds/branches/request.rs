//! Request for branches: a scene at one speed, and the number of it that changes.

use serde::{Deserialize, Serialize};

use crate::kinds::case_study::request::CaseSpeed;
use crate::request::auto_or::AutoOr;
use crate::request::integration::Integration;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::sweep::{SweepRequest, default_max_engine_order};

/// Periodic responses, followed while a number of their scene changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct BranchesRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter; `"auto"` is 20.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// Speed at which a periodic response is sought, from where it is followed.
    pub speed: CaseSpeed,
    /// Number of the scene that changes along the branches, and its range.
    pub along: Along,
    /// Effects of the simulation.
    pub scene: Scene,
    /// Time integration. Scheme and steps per revolution are the same everywhere: those of the speed that needs most. A search takes at
    /// most four times the revolutions that a march may take, and as many again from heavier damping.
    #[serde(default)]
    pub integration: Integration,
    /// Sensors whose amplitudes are reported; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of interest: a revolution has at least eight samples for each, and at least 512.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Whether the branches onto which motions double their period are followed, too.
    #[serde(default = "yes")]
    pub doubled: bool,
    /// Largest number of points of a branch on either side of where it begins.
    #[serde(default = "most_points")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 10_000))]
    pub most_points: u32,
}

/// Number of the scene that changes, and its range: the branch is followed both ways from where it is found until it leaves the range. For a speed,
/// `from` and `to` are in the unit of `speed` and have it between them; for the other numbers, they are multiples of what the scene says, with 1
/// between them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Along {
    /// Parameter: which number of the scene changes.
    pub parameter: BranchParameter,
    /// Smallest value of the parameter.
    pub from: f64,
    /// Largest value of the parameter.
    pub to: f64,
}

/// Number of a scene that changes along a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum BranchParameter {
    /// Rotational speed.
    Speed,
    /// All clearances alike.
    Clearance,
    /// Height of the casing's lobes.
    LobeAmplitude,
    /// All damping ratios alike.
    Damping,
}

impl BranchParameter {
    /// Name of the parameter on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Clearance => "clearance",
            Self::LobeAmplitude => "lobe_amplitude",
            Self::Damping => "damping",
        }
    }
}

/// Branches as they are stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct BranchesSettings {
    /// Scene at the speed where the branches begin, as a sweep.
    pub sweep: SweepRequest,
    /// Number of the scene that changes along the branches, and its range; a speed in rad/s.
    pub along: Along,
    /// Whether branches of doubled period are followed, too.
    pub doubled: bool,
    /// Largest number of points of a branch on either side of where it begins.
    pub most_points: u32,
}

fn yes() -> bool {
    true
}

fn most_points() -> u32 {
    400
}
