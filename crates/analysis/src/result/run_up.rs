//! What run-ups come to.

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
    /// Whose displacements are told.
    pub sensors: Vec<Sensor>,
    /// Units of lengths.
    pub units: Units,
    /// Whether all runs have ended; otherwise the job is still at it, or was stopped.
    pub complete: bool,
    /// In the order of `rates`, those that have begun.
    pub runs: Vec<RunUp>,
    /// How fast one must pass to stay below `limit`; absent without one, without rates, and until all runs have ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub passing: Option<PassingRate>,
    /// What was asked for, with every default filled in.
    pub settings: RunUpSettings,
    /// Version of the program.
    pub version: String,
    /// Kind of vectors of the processor.
    pub vectors: String,
}

/// A run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUp {
    /// Its number, from 0.
    pub run: u32,
    /// By how much the speed changes, rad/s² without a sign; absent of a run through points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_rad_s2: Option<f64>,
    /// Order of the second line of a spectrum: lines are multiples of it.
    pub order_step: f64,
    /// What it was up to, frame by frame.
    pub frames: Vec<RunUpFrame>,
    /// How it ended; absent while it has not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<RunUpEnd>,
}

/// Some revolutions of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUpFrame {
    /// Revolutions before it.
    pub revolution: u64,
    /// When it begins and ends, s.
    pub times_s: [f64; 2],
    /// Speeds then, rad/s.
    pub speeds_rad_s: [f64; 2],
    /// Largest displacement of every sensor at any sector: the envelope.
    pub largest: Vec<f64>,
    /// Half the peak-to-peak displacement of every sensor at its own sector: what a sweep tells of a speed.
    pub half_peak_to_peak: Vec<f64>,
    /// Share of its steps in which something touches.
    pub contact_share: f64,
    /// Amplitudes of every sensor at its own sector, line by line of the order; under a Hann window, and in frames of more than eight revolutions
    /// the largest of those of eight at a time. Empty of a last frame that is shorter than the others. Kept apart, and told as a [`Spectrogram`].
    #[serde(default, skip_serializing)]
    #[cfg_attr(feature = "schema", schema(ignore))]
    pub spectra: Vec<Vec<f64>>,
}

/// How a run ended, and what it is worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUpEnd {
    /// Whether it came to its end.
    pub status: PointStatus,
    /// Why it did not, or what must be known of it: that it ends at its largest displacement, within a critical speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Largest displacement of every sensor, at any sector, and where.
    pub largest: Vec<LargestOfRun>,
    /// Scheme and step at the lowest speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Revolutions that it took.
    pub revolutions: f64,
    /// Steps.
    pub steps: u64,
    /// Pieces of one speed each.
    pub segments: u64,
    /// Most that the angle was off within a piece, rad.
    pub largest_angle_error_rad: f64,
    /// Largest mechanical energy, force·length.
    pub largest_energy: f64,
    /// Largest violation of the energy identity within a piece, of the largest energy.
    pub energy_residual: f64,
    /// Energy that the changing stiffness gave, force·length: it comes from the shaft.
    pub stiffening_work: f64,
    /// Energy lost in handing on the state, of the largest energy: of modes that are not integrated at the next speed.
    pub transfer_loss: f64,
    /// Share of the steps in which something touched.
    pub contact_share: f64,
    /// Largest penetration that a solution left, length; absent without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_penetration: Option<f64>,
    /// Euler force over centrifugal force, |Ω̇|/Ω², at most: without `euler_force` the static deflection of the wheel is off by so much.
    pub euler_share: f64,
    /// Computing time, s.
    pub wall_time_s: f64,
}

/// The largest displacement of a sensor in a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LargestOfRun {
    /// How large, length.
    pub displacement: f64,
    /// When, s.
    pub time_s: f64,
    /// At which speed, rad/s.
    pub speed_rad_s: f64,
}

/// How fast one must pass to stay below a limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PassingRate {
    /// The limit, length.
    pub limit: f64,
    /// The slowest rate from which on all faster ones that were run stay below, rad/s²; absent if the fastest does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub enough_rad_s2: Option<f64>,
    /// The next slower one, at which the limit is exceeded, rad/s²; absent if none was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub too_slow_rad_s2: Option<f64>,
    /// Between the two, straight in the logarithms of rate and displacement, rad/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about_rad_s2: Option<f64>,
    /// In words.
    pub message: String,
}

/// Amplitudes of a run over engine order and speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Spectrogram {
    /// Number of the run.
    pub run: u32,
    /// By how much its speed changes, rad/s² without a sign; absent of a run through points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_rad_s2: Option<f64>,
    /// The sensor.
    pub sensor: Sensor,
    /// Units of lengths.
    pub units: Units,
    /// Engine orders of the lines. A line has the frequency of its order times the speed over 2π.
    pub engine_orders: Vec<f64>,
    /// Middle of every frame, s.
    pub times_s: Vec<f64>,
    /// Speeds at the beginning and the end of every frame, rad/s. A frequency that stays while the speed changes is smeared over as much of
    /// its order.
    pub speeds_rad_s: Vec<[f64; 2]>,
    /// `[frame][line]`: amplitudes at the sensor's sector, under a Hann window.
    pub amplitudes: Vec<Vec<f64>>,
    /// What was asked for, with every default filled in.
    pub settings: RunUpSettings,
    /// Version of the program.
    pub version: String,
}

/// Some frames of a run: as they are kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunUpLeg {
    pub(crate) run: u32,
    pub(crate) order_step: f64,
    pub(crate) frames: Vec<RunUpFrame>,
    /// Of the last leg of a run.
    pub(crate) end: Option<RunUpEnd>,
    pub(crate) vectors: String,
}

/// What run-ups will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RunUpPlan {
    /// Every effect a scene may name, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Symmetry of the scene.
    pub symmetry: FoundSymmetry,
    /// Pairs of contact node and casing; see the plan of a sweep.
    pub contact_pairs: u64,
    /// Whether the reduction that they rest on is there. While it is not, times and steps are left out.
    pub reduction: ReductionState,
    /// The whole reduced wheel has at most so many real unknowns; see the plan of a sweep.
    pub reduced_unknowns_at_most: u64,
    /// The machine whose steps were measured for the times below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<Machine>,
    /// The runs.
    pub runs: Vec<PlannedRunUp>,
    /// Cost of all of them, one after the other by one worker. Absent where one cannot be integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    /// What its numbers will not be worth: a K(Ω) that cannot be trusted between the speeds at which the stiffness is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The whole request as resolved.
    pub settings: RunUpSettings,
    /// Version of the code.
    pub version: String,
}

/// What a run takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PlannedRunUp {
    /// By how much the speed changes, rad/s² without a sign; absent of a run through points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_rad_s2: Option<f64>,
    /// How long it lasts, s.
    pub duration_s: f64,
    /// Revolutions.
    pub revolutions: f64,
    /// Revolutions of a frame.
    pub frame_revolutions: u64,
    /// Pieces of one speed each.
    pub segments: u64,
    /// Why it cannot be integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Scheme and step at the lowest speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// Computing time, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub computing_time_s: Option<CostRange>,
}
