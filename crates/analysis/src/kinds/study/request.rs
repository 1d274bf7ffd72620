//! Request for a convergence study: a scene, a few speeds, a grid of settings.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::{Integration, SchemeChoice, SteadyChoice};
use crate::request::record::StressRequest;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::Speeds;

/// A convergence study: errors of a grid of settings against a reference one level finer, and what each costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct StudyRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Speeds of the study, one to eight.
    pub speeds: Speeds,
    /// Effects of the simulation.
    pub scene: Scene,
    /// Grid of settings, of which every combination is run.
    #[serde(default)]
    pub grid: Grid,
    /// Length of a run, and how its steady response is found.
    #[serde(default)]
    pub integration: StudyIntegration,
    /// Revolutions from the start over which displacements are compared, before chaos separates trajectories; for a response that was solved for, its
    /// first ones.
    #[serde(default = "default_history_revolutions")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub history_revolutions: u32,
    /// Sensors at which the response is recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order that is compared.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Recordings that are compared beside displacement and contact.
    #[serde(default, skip_serializing_if = "StudyRecord::is_nothing")]
    pub record: StudyRecord,
    /// Whether the rows of the bases of the study's reductions are stored, as in a sweep; `false` leaves them out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
}

/// Recordings of every run of a study beside displacement and contact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct StudyRecord {
    /// Stress, as in a sweep: the largest von Mises stress is compared (`errors.stress`). Needs a model with a mesh. Times are those of the
    /// simulation without stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<StressRequest>,
}

impl StudyRecord {
    fn is_nothing(&self) -> bool {
        *self == Self::default()
    }
}

fn default_history_revolutions() -> u32 {
    3
}

fn default_max_engine_order() -> u32 {
    24
}

/// Settings of a study. The defaults are the paper's five numbers of modes by all schemes. With ten sectors of ten contact nodes and three stiffness
/// speeds they make at most 330, 540, 900, 1140 and 1560 unknowns, the paper's sizes; nearly dependent directions are dropped, which leaves the
/// demo's impeller 330, 492, 728, 891 and 1169. `reductions[].wheel_unknowns` of the result has the numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Grid {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub modes_per_speed: Vec<u32>,
    /// Time steps per revolution; each is rounded up so that all histories share their instants.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub steps_per_revolution: Vec<u32>,
    /// Schemes, none of them `auto`.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub schemes: Vec<SchemeChoice>,
    /// Modes per nodal diameter that `massless_boundary` integrates.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub kept_modes: Vec<AutoOr>,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            modes_per_speed: vec![1, 8, 20, 28, 42],
            steps_per_revolution: vec![450, 900, 1800, 3600, 7200, 14_400],
            schemes: vec![
                SchemeChoice::ExactModal,
                SchemeChoice::MasslessBoundary,
                SchemeChoice::CentralDifferences,
            ],
            kept_modes: vec![AutoOr::Auto],
        }
    }
}

/// Settings of the time integration of a study: the length of a run, as in a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct StudyIntegration {
    /// Revolutions to simulate.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub revolutions: u32,
    /// Revolutions over which the restriction grows from zero to its full height.
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub ramp_revolutions: f64,
    /// Revolutions at the end of the run that spectra are computed from.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub window_revolutions: u32,
    /// How the steady response of every run is found. Histories are those of the response that was taken.
    pub steady: SteadyChoice,
}

impl Default for StudyIntegration {
    fn default() -> Self {
        let Integration { ramp_revolutions, window_revolutions, steady, .. } = Integration::default();
        Self { revolutions: 50, ramp_revolutions, window_revolutions, steady }
    }
}
