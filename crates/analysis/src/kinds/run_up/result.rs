//! Results and plans of run-ups.

use serde::{Deserialize, Serialize};

use crate::effects::symmetry::result::FoundSymmetry;
use crate::request::{RunUpSettings, Sensor};
use crate::result::plan::{CostRange, Estimate, Machine, PlannedEffect, ReductionState};
use crate::result::point::{PointStatus, SchemeReport};
use rubmap_wheel::dynamics::sector::Units;

/// Run-ups or run-downs of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUps {
    /// Sensors whose displacements are reported.
    pub sensors: Vec<Sensor>,
    /// Units of the model.
    pub units: Units,
    /// Whether all runs have ended; otherwise the job is still running, or was stopped.
    pub complete: bool,
    /// Runs that have begun, in the order of `rates`.
    pub runs: Vec<RunUp>,
    /// Rate that is fast enough to stay below `limit`; absent without a limit, without rates, and until all runs have ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub passing: Option<PassingRate>,
    /// Request with every default filled in.
    pub settings: RunUpSettings,
    /// Version of the program.
    pub version: String,
    /// Kind of vector instructions of the processor: another kind may round differently.
    pub vectors: String,
}

/// A single run-up or run-down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUp {
    /// Number of the run, from 0.
    pub run: u32,
    /// Rate at which the speed changes, rad/s² without a sign; absent for a run through points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_rad_s2: Option<f64>,
    /// Engine order of the second line of a spectrum: lines are multiples of it.
    pub order_step: f64,
    /// Frames of the run: some revolutions each.
    pub frames: Vec<RunUpFrame>,
    /// How the run ended; absent while it goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<RunUpEnd>,
}

/// Frame of a run: some of its revolutions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUpFrame {
    /// Revolutions before the frame.
    pub revolution: u64,
    /// Times at the beginning and the end of the frame, s.
    pub times_s: [f64; 2],
    /// Speeds at the beginning and the end of the frame, rad/s.
    pub speeds_rad_s: [f64; 2],
    /// Envelope: largest displacement of every sensor at any sector.
    pub largest: Vec<f64>,
    /// Half the peak-to-peak displacement of every sensor at its own sector: what a sweep reports for a speed.
    pub half_peak_to_peak: Vec<f64>,
    /// Share of the steps of the frame in which something touches.
    pub contact_share: f64,
    /// Amplitudes of every sensor at its own sector, line by line of the engine order, under a Hann window; in frames of more than eight revolutions
    /// the largest of those of eight at a time. Empty for a last frame that is shorter than the others. Stored apart, and reported as a
    /// [`Spectrogram`].
    #[serde(default, skip_serializing)]
    #[cfg_attr(feature = "schema", schema(ignore))]
    pub spectra: Vec<Vec<f64>>,
}

/// How a run ended, and how far its numbers can be trusted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUpEnd {
    /// Status of the run: whether it came to its end.
    pub status: PointStatus,
    /// Reason for which the run did not come to its end, or a remark on it: that it ends at its largest displacement, within a critical speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Largest displacement of every sensor, at any sector, with time and speed.
    pub largest: Vec<LargestOfRun>,
    /// Scheme and step at the lowest speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Revolutions that the run took.
    pub revolutions: f64,
    /// Number of steps of the run.
    pub steps: u64,
    /// Number of segments of the run, each of one speed.
    pub segments: u64,
    /// Largest error of the angle within a segment, rad.
    pub largest_angle_error_rad: f64,
    /// Largest mechanical energy of the run, force·length.
    pub largest_energy: f64,
    /// Largest violation of the energy identity within a segment, relative to the largest energy.
    pub energy_residual: f64,
    /// Largest difference between work and energy of blades that stiffen as they bend within a segment, relative to the largest energy; of second
    /// order in the step where nothing touches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending_residual: Option<f64>,
    /// Work of the changing stiffness, force·length: energy that comes from the shaft.
    pub stiffening_work: f64,
    /// Energy lost where a segment hands its state on to the next, relative to the largest energy: that of modes that are not integrated at the next
    /// speed.
    pub transfer_loss: f64,
    /// Share of the steps in which something touched.
    pub contact_share: f64,
    /// Largest penetration that a contact solution left, length; absent without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_penetration: Option<f64>,
    /// Largest ratio of the Euler force to the centrifugal force, |Ω̇|/Ω²: without `euler_force` the static deflection of the wheel is off by this
    /// share.
    pub euler_share: f64,
    /// Computing time of the run, s.
    pub wall_time_s: f64,
}

/// The largest displacement of a sensor in a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LargestOfRun {
    /// Largest displacement, length.
    pub displacement: f64,
    /// Time of the largest displacement, s.
    pub time_s: f64,
    /// Speed at the largest displacement, rad/s.
    pub speed_rad_s: f64,
}

/// Rate of change of the speed that is fast enough to stay below a limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PassingRate {
    /// Limit that the displacement should not exceed, length.
    pub limit: f64,
    /// Slowest rate from which on all faster ones that were run stay below the limit, rad/s²; absent if the fastest does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub enough_rad_s2: Option<f64>,
    /// Next slower rate that was run, at which the limit is exceeded, rad/s²; absent if none was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub too_slow_rad_s2: Option<f64>,
    /// Interpolated rate between `too_slow_rad_s2` and `enough_rad_s2`, straight in the logarithms of rate and displacement, rad/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about_rad_s2: Option<f64>,
    /// Finding in words.
    pub message: String,
}

/// Amplitudes of a run over engine order and speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Spectrogram {
    /// Number of the run.
    pub run: u32,
    /// Rate at which the speed changes, rad/s² without a sign; absent for a run through points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_rad_s2: Option<f64>,
    /// Sensor that was recorded.
    pub sensor: Sensor,
    /// Units of the model.
    pub units: Units,
    /// Engine orders of the lines. A line has the frequency of its order times the speed over 2π.
    pub engine_orders: Vec<f64>,
    /// Time at the middle of every frame, s.
    pub times_s: Vec<f64>,
    /// Speeds at the beginning and the end of every frame, rad/s. A frequency that stays while the speed changes is smeared over as much of
    /// its order.
    pub speeds_rad_s: Vec<[f64; 2]>,
    /// Amplitudes at the sensor's sector, `[frame][line]`, under a Hann window.
    pub amplitudes: Vec<Vec<f64>>,
    /// Request with every default filled in.
    pub settings: RunUpSettings,
    /// Version of the program.
    pub version: String,
}

/// Leg of a run: some of its frames, as they are stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunUpLeg {
    pub(crate) run: u32,
    pub(crate) order_step: f64,
    pub(crate) frames: Vec<RunUpFrame>,
    /// How the run ended, in its last leg.
    pub(crate) end: Option<RunUpEnd>,
    pub(crate) vectors: String,
}

/// Plan of run-ups: what they will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUpPlan {
    /// Every effect a scene may name, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Symmetry of the scene.
    pub symmetry: FoundSymmetry,
    /// Pairs of contact node and casing; see the plan of a sweep.
    pub contact_pairs: u64,
    /// Whether the reduction that the runs rest on is stored. While it is not, times and steps are left out.
    pub reduction: ReductionState,
    /// Largest number of real unknowns of the whole reduced wheel; see the plan of a sweep.
    pub reduced_unknowns_at_most: u64,
    /// Machine whose steps were measured for the times of this plan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<Machine>,
    /// Planned runs.
    pub runs: Vec<PlannedRunUp>,
    /// Cost of all runs, one after the other by one worker. Absent where one of them cannot be integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    /// Warnings about numbers that cannot be relied on: a K(Ω) that cannot be trusted between the speeds at which the stiffness is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The whole request as resolved.
    pub settings: RunUpSettings,
    /// Version of the code.
    pub version: String,
}

/// Plan of a single run-up or run-down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PlannedRunUp {
    /// Rate at which the speed changes, rad/s² without a sign; absent for a run through points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_rad_s2: Option<f64>,
    /// Duration of the run, s.
    pub duration_s: f64,
    /// Revolutions of the run.
    pub revolutions: f64,
    /// Revolutions of a frame.
    pub frame_revolutions: u64,
    /// Number of segments of the run, each of one speed.
    pub segments: u64,
    /// Reason for which the run cannot be integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Scheme and step at the lowest speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Number of steps of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// Computing time of the run, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub computing_time_s: Option<CostRange>,
}
