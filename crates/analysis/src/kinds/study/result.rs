//! Results of a convergence study.

use serde::{Deserialize, Serialize};

use crate::request::{AutoOr, SchemeChoice, Sensor, Setting, StudyRequest};
use crate::result::errors::{Errors, Quantity};
use crate::result::plan::PlannedEffect;
use crate::result::point::PointStatus;
use crate::result::reduction::StiffeningVerdict;
use crate::result::steady::SteadyReport;
use crate::result::trial::Cost;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::sensitivity::Sensitivity;
use rubmap_wheel::response::settling::Verdict;

/// Errors of every setting of a study against its reference, with the cost of each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WorkPrecision {
    /// Errors and costs at each speed.
    pub speeds: Vec<SpeedStudy>,
    /// Reductions that the study rests on, by `modes_per_speed`.
    pub reductions: Vec<StudyReduction>,
    /// The whole request as resolved.
    pub settings: StudyRequest,
    /// Version of the code.
    pub version: String,
}

/// Plan of a study: the runs that it will make.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StudyPlan {
    /// Every effect a scene may name, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Number of speeds.
    pub speeds: u32,
    /// Number of runs of the grid and of the references at all speeds; runs that are stored are not repeated.
    pub simulations: u32,
    /// Time steps of all runs.
    pub steps: u64,
    /// Reductions that the runs rest on, by `modes_per_speed`.
    pub reductions: Vec<u32>,
    /// Warnings about numbers that cannot be relied on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The whole request as resolved.
    pub settings: StudyRequest,
    /// Version of the code.
    pub version: String,
}

/// A reduction that a study rests on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StudyReduction {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k.
    pub modes_per_speed: u32,
    /// Real unknowns of the whole reduced wheel.
    pub wheel_unknowns: u32,
    /// Wall time of the reduction, s.
    pub wall_time_s: f64,
    /// How far K(Ω) can be trusted between the given speeds; absent for a study that an earlier version made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<StiffeningVerdict>,
}

/// One speed of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SpeedStudy {
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Reference that all runs are compared with; it has no errors.
    pub reference: StudyRun,
    /// Growth of a tiny perturbation of the reference, which decides whether trajectories can be compared. Absent if the reference failed, or was
    /// solved for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<Sensitivity>,
    /// How to read the errors, in words.
    pub message: String,
    /// Runs, one per setting.
    pub runs: Vec<StudyRun>,
    /// Observed orders in the time step, one per size and scheme.
    pub orders: Vec<StepOrder>,
}

/// A setting of a study: its errors and its cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StudyRun {
    /// Setting of the run.
    #[serde(flatten)]
    pub setting: Setting,
    /// Real unknowns that are integrated; 0 if nothing was.
    pub unknowns: u32,
    /// How the run ended.
    pub status: PointStatus,
    /// Reason for which the run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Steady-state verdict of a completed run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// Periodic response; absent unless the request's `integration.steady` asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadyReport>,
    /// Largest violation of the energy identity, relative to the largest energy seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_residual: Option<f64>,
    /// Differences from the reference; absent unless both runs were completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<Errors>,
    /// CPU time of the run, by its parts.
    pub cost: Cost,
    /// CPU time of the whole run, s: `set_up_s` and all revolutions.
    pub time_s: f64,
    /// Quantities for which no other run has a smaller error in less time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pareto: Vec<Quantity>,
}

/// Observed order in the time step of one size and scheme, from the displacement over the first revolutions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StepOrder {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// Time-stepping scheme.
    pub scheme: SchemeChoice,
    /// Modes that `massless_boundary` was asked to integrate; with `auto` their number grows with the steps, and the order is
    /// that of both together.
    pub kept_modes: AutoOr,
    /// Steps per revolution, ascending.
    pub steps_per_revolution: Vec<u32>,
    /// Relative difference of each step from the next finer one; null where there is nothing to compare, and none for the last step.
    pub differences: Vec<Option<f64>>,
    /// Order observed over each three successive steps; null where differences do not fall or are round-off.
    pub orders: Vec<Option<f64>>,
}

/// Displacements over the first revolutions, one line per size: the paper's Figs 6 and 7.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Histories {
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Sensors that are recorded.
    pub sensors: Vec<Sensor>,
    /// Samples of a revolution; the first is one sampling interval after the start.
    pub samples_per_revolution: u32,
    /// Displacements in ascending size, those of the reference last.
    pub lines: Vec<HistoryLine>,
    /// Units of the model.
    pub units: Units,
    /// Version of the code.
    pub version: String,
}

/// The displacements of one size at the finest step of the grid's first scheme that completed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct HistoryLine {
    /// Setting of the line.
    #[serde(flatten)]
    pub setting: Setting,
    /// Whether the line is that of the reference.
    pub reference: bool,
    /// Real unknowns that are integrated.
    pub unknowns: u32,
    /// Displacements, `[sensor][sample]`.
    pub displacement: Vec<Vec<f64>>,
}

/// Indices of the points (time, error) of the Pareto front: those that no other one is as good as in both and better in one.
pub fn front(points: &[Option<(f64, f64)>]) -> Vec<usize> {
    let beaten = |(time, error): (f64, f64)| {
        points.iter().flatten().any(|&(t, e)| t <= time && e <= error && (t < time || e < error))
    };
    let on =
        |(index, point): (usize, &Option<(f64, f64)>)| point.filter(|&point| !beaten(point)).map(|_| index);
    points.iter().enumerate().filter_map(on).collect()
}
