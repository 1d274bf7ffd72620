//! Request for run-ups: a scene, and how its speed changes.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::{Integration, SchemeChoice};
use crate::request::omit::is_false;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::SpeedUnit;
use crate::request::sweep::{SweepRequest, default_max_engine_order};

/// Run-ups or run-downs: a scene whose speed changes as given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct RunUpRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter; `"auto"` is 20.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// How the speed changes.
    pub speed: RunUpSpeed,
    /// Effects of the simulation: all but `abradable`, `flexible_casing` and a `symmetry` other than `full`.
    pub scene: Scene,
    /// Time integration.
    #[serde(default)]
    pub integration: RunUpIntegration,
    /// Sensors whose displacements are recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Whether the Euler force acts, which pushes along the circumference while the speed changes: on the wheel at rest in its frame and,
    /// with `coriolis`, on the vibration. The package must have elements.
    #[serde(default)]
    pub euler_force: bool,
    /// Highest engine order of the spectrogram.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Angle by which the wheel may be off within a segment that is stepped at one speed, rad: both ends of every segment are where the speed puts
    /// them. A quarter of this angle halves the length of the segments.
    #[serde(default = "default_tolerance")]
    #[cfg_attr(feature = "schema", schema(minimum = 1e-8, maximum = 0.1))]
    pub angle_tolerance_rad: f64,
    /// Revolutions of a frame, of which the largest displacement and a spectrum are reported: 1 to 8, or a multiple of 8. `"auto"` is 8, and more
    /// where there would be over 1,000 frames.
    #[serde(default)]
    pub frame_revolutions: AutoOr,
    /// Displacement that should not be exceeded, in the model's unit of length: with several `rates` the result says how fast one must pass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub limit: Option<f64>,
}

/// How the speed changes: at constant `rates` between `from` and `to`, one run for each, or through `points`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct RunUpSpeed {
    /// Unit of all speeds; rates are in this unit per second.
    pub unit: SpeedUnit,
    /// Speed at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub from: Option<f64>,
    /// Speed at the end; if it is below `from`, the wheel runs down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub to: Option<f64>,
    /// Rates of change of the speed, per second and without a sign: one run for each.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 100))]
    pub rates: Option<Vec<f64>>,
    /// Time for which the speed stays at `from` before it changes, s, in which the transient of the start dies away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub hold_s: Option<f64>,
    /// Speeds at times, in place of `from`, `to`, `rates` and `hold_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 2, max_items = 10_000))]
    pub points: Option<Vec<SpeedPoint>>,
    /// How the speed goes through the points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub course: Option<SpeedCourse>,
}

/// A speed at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct SpeedPoint {
    /// Time of the point, s; 0 for the first, then ascending.
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub time_s: f64,
    /// Speed at that time.
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub speed: f64,
}

/// Course of a speed through points.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SpeedCourse {
    /// Straight from one point to the next; the default.
    #[default]
    Straight,
    /// Smooth: without corners, level at both ends, and never beyond two neighbours (monotone cubics).
    Smooth,
}

/// Settings of the time integration of a run-up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct RunUpIntegration {
    /// Time-stepping scheme; `"auto"` keeps to one scheme.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates, or `"auto"` for as many as the step carries.
    pub kept_modes: AutoOr,
    /// Time steps per revolution, or `"auto"`: a safe number for the lowest speed of every range of √2.
    pub steps_per_revolution: AutoOr,
    /// Revolutions over which the restriction grows from zero to its full height.
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub ramp_revolutions: f64,
}

impl Default for RunUpIntegration {
    fn default() -> Self {
        let Integration { scheme, kept_modes, steps_per_revolution, ramp_revolutions, .. } =
            Integration::default();
        Self { scheme, kept_modes, steps_per_revolution, ramp_revolutions }
    }
}

impl RunUpIntegration {
    /// Settings of a sweep with the same scheme, modes, steps and ramp.
    pub(crate) fn of_sweep(self) -> Integration {
        let Self { scheme, kept_modes, steps_per_revolution, ramp_revolutions } = self;
        Integration { scheme, kept_modes, steps_per_revolution, ramp_revolutions, ..Integration::default() }
    }
}

/// Run-ups as they are stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct RunUpSettings {
    /// Scene at the lowest and the highest speed, as a sweep.
    pub sweep: SweepRequest,
    /// How the speed changes, in rad/s.
    pub speed: RunUpSpeed,
    /// Whether the Euler force acts.
    #[serde(default, skip_serializing_if = "is_false")]
    pub euler_force: bool,
    /// Angle by which the wheel may be off within a segment, rad.
    pub angle_tolerance_rad: f64,
    /// Revolutions of a frame.
    pub frame_revolutions: AutoOr,
    /// Displacement that should not be exceeded, in the model's unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
}

fn default_tolerance() -> f64 {
    1e-3
}
