//! Plans: what jobs will do and cost.

use serde::{Deserialize, Serialize};

use crate::effects::casing::result::FoundShape;
use crate::effects::symmetry::result::FoundSymmetry;
use crate::request::{BranchesSettings, ModalAnalysisRequest, SweepRequest};
use crate::result::choice::{Choice, ModesChoice};
use crate::result::point::{Point, SchemeReport};

/// Plan of a sweep: what it will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SweepPlan {
    /// Every effect a scene may name, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Symmetry of the scene.
    pub symmetry: FoundSymmetry,
    /// Shape of the scene's casing; absent without a casing and for a circular one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_shape: Option<FoundShape>,
    /// Pairs of contact node and casing: all contact nodes of all simulated sectors where the scene has contact, otherwise none. A
    /// node whose clearance is too large ever to be closed counts too; it costs its gap in every step.
    pub contact_pairs: u64,
    /// Whether the reduction that the sweep rests on is stored. While it is not, `points` and `estimate` are left out.
    pub reduction: ReductionState,
    /// Largest number of real unknowns of the whole reduced wheel: the exact number if the reduction is stored, otherwise N(n_b + speeds·k), of which
    /// nearly dependent directions will be dropped.
    pub reduced_unknowns_at_most: u64,
    /// Largest size of the basis of a reduction that has still to be computed, bytes of disk as long as the model is there: rows of 16 bytes an
    /// unknown, one for every DOF and nodal diameter. Absent where the reduction is stored, and where `fields` is false.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub basis_bytes_at_most: Option<u64>,
    /// Approximate size of stress in the coordinates of the reduction, bytes of disk as long as the model is there, and of memory while speeds run;
    /// only for a sweep that records stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress_bytes: Option<u64>,
    /// Positions of those sensors that name a node or a point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub placed_sensors: Vec<PlacedSensor>,
    /// Number of speeds to simulate, those of the request.
    pub speeds: u32,
    /// Largest number of speeds that `refine` adds to them; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub added_speeds_at_most: Option<u32>,
    /// Most speeds that are simulated once more, in the end, to measure the validity of linear theory where geometry leaves it open; in the upper
    /// bounds of `estimate`. 0 for models without a mesh and without the basis of the reduction, 1 for sweeps up or down, of which all
    /// speeds before it are simulated, too.
    #[serde(default)]
    pub validity_speeds_at_most: u32,
    /// Threads that compute speeds side by side, on all machines; one where each speed starts from the end of another.
    pub workers: u32,
    /// Machine whose steps were measured for the times of this plan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<Machine>,
    /// Planned speeds: every speed if there are no more than three, otherwise the slowest, the middle and the fastest one; of wheels with large
    /// eigenproblems the slowest alone, which usually takes most steps.
    pub points: Vec<PlannedPoint>,
    /// Cost of all speeds together; absent where none of `points` can be integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    /// Setting that pilot runs of earlier jobs choose for the accuracy or the budget asked for; `points` and `estimate` are for it. Pilot runs that
    /// are stored cost nothing of a budget; a job that still has to run them has less of it left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<Choice>,
    /// Speeds of the pilot runs that the job begins with, rad/s; absent where none are missing. Choosing may take `settings.accuracy.seconds`; a
    /// budget is for the whole job.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pilot_speeds_rad_s: Option<Vec<f64>>,
    /// Warnings: a K(Ω) that cannot be trusted between the speeds at which the stiffness is given, operating ranges that the speeds do not cover.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The whole request as resolved, with the setting chosen in place of what was asked for.
    pub settings: SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// A machine that computes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Machine {
    /// Name of the machine.
    pub name: String,
    /// Processor of the machine, as the system calls it.
    pub processor: String,
    /// Processors that the system gives to the program.
    pub processors: u32,
    /// Kind of vector instructions of the processor: another kind may round differently.
    pub vectors: String,
}

/// Position of a sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PlacedSensor {
    /// Index of the sensor in the request.
    pub sensor: u32,
    /// Id of the sensor's node; for a gauge, the first of two.
    pub node: u64,
    /// Position of the node, x, y, z as in the package.
    pub position: [f64; 3],
    /// Index of the node among the contact nodes, if it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_node: Option<u32>,
    /// Distance of the node from the point that the request names, if it names one; for a gauge, the larger distance of its two ends from where they
    /// should be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Second node of a gauge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<GaugeEnd>,
    /// Angle between the gauge and the direction asked for, in degrees, at most 20; for a gauge that was asked for at a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    /// Length asked for, in the model's unit of length, for a gauge that was asked for at a point; the gauge's own length is within a quarter of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asked_length: Option<f64>,
}

/// The second node of a strain gauge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct GaugeEnd {
    /// Id of the gauge's second node.
    pub node: u64,
    /// Position of the gauge's second node, x, y, z as in the package.
    pub position: [f64; 3],
    /// Length of the gauge: the distance between its nodes.
    pub length: f64,
}

/// Whether a reduction is stored or has to be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub enum ReductionState {
    /// Reduction computed before, and stored.
    #[serde(rename = "stored")]
    Stored,
    /// Reduction to be computed, as the first task of the job.
    #[serde(rename = "to be computed")]
    ToBeComputed,
}

/// Plan of one speed of a sweep: what it will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PlannedPoint {
    /// Index of the speed in the request.
    pub index: u32,
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Reason for which this speed cannot be integrated; all numbers but the speed are then absent or 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Largest length by which the casing stands inside a tip at rest, in the model's unit of length: that far contact bends the blades, even where
    /// nothing vibrates. Absent where the casing stands clear of the tips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interference: Option<f64>,
    /// Real unknowns that are integrated.
    pub integrated_unknowns: u32,
    /// Scheme and step, and the reason that set them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Steps per revolution.
    pub steps_per_revolution: u32,
    /// Steps of the whole run; an upper bound where a march ends once it repeats or a periodic response is solved for.
    pub steps: u64,
    /// Computing time of this speed, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub computing_time_s: Option<CostRange>,
    /// Memory that this speed holds while it runs.
    pub memory_bytes: u64,
}

/// Cost that depends on how much contact there will be.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CostRange {
    /// Cost if nothing ever touches; for a march that ends once it repeats, if it ends as early as it may.
    pub free: f64,
    /// Cost if something touches in every step, and no march ends before its limit.
    pub contact: f64,
}

/// Cost of all speeds of a sweep, or of a branch, from a calibration of this machine; without the reduction and without the speeds that
/// `refine` adds. Upper bounds have what measuring the validity of linear theory takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Estimate {
    /// Steps over all speeds, counted as for a single speed.
    pub steps: u64,
    /// Computing time summed over the speeds, s; compare `spent.computing_time_s`.
    pub computing_time_s: CostRange,
    /// Time from the first to the last speed with all workers on this sweep, s.
    pub wall_time_s: CostRange,
    /// Threads that compute speeds side by side.
    pub workers: u32,
    /// Memory of the speeds that run side by side, and of the reduced wheel; that of measuring the validity of linear theory where it is more.
    pub memory_bytes: u64,
    /// Memory that one speed holds while it runs; 0 in plans of earlier versions.
    #[serde(default)]
    pub speed_memory_bytes: u64,
}

impl Estimate {
    /// Adds the cost of what is computed afterwards, by no more workers.
    pub(crate) fn followed_by(self, later: Self) -> Self {
        let both =
            |a: CostRange, b: CostRange| CostRange { free: a.free + b.free, contact: a.contact + b.contact };
        Self {
            steps: self.steps + later.steps,
            computing_time_s: both(self.computing_time_s, later.computing_time_s),
            wall_time_s: both(self.wall_time_s, later.wall_time_s),
            memory_bytes: self.memory_bytes.max(later.memory_bytes),
            ..self
        }
    }
}

/// Cost of the finished speeds of a sweep, as measured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Spent {
    /// Computing time summed over the speeds, s; compare `plan.computing_time_s`. Speeds that ran side by side took less wall time.
    pub computing_time_s: f64,
    /// Steps taken on the finished speeds.
    pub steps: u64,
}

impl Spent {
    pub(crate) fn on<'a>(points: impl IntoIterator<Item = &'a Point>) -> Self {
        points.into_iter().fold(Self::default(), |sum, point| Self {
            computing_time_s: sum.computing_time_s + point.wall_time_s,
            steps: sum.steps + point.steps,
        })
    }
}

/// Plan of a modal analysis: what it will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ModalAnalysisPlan {
    /// Effects that natural frequencies can have.
    pub effects: Vec<PlannedEffect>,
    /// Whether the reduction that the analysis rests on is stored.
    pub reduction: ReductionState,
    /// Largest number of real unknowns of the whole reduced wheel: the exact number if the reduction is stored, otherwise N(n_b + speeds·k), of which
    /// nearly dependent directions will be dropped.
    pub reduced_unknowns_at_most: u64,
    /// Largest size of the basis of a reduction that has still to be computed, bytes of disk; see the plan of a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub basis_bytes_at_most: Option<u64>,
    /// Number of speeds of the diagram.
    pub speeds: u32,
    /// Eigenproblems solved at each speed, one a nodal diameter.
    pub nodal_diameters: u32,
    /// Computing time of the frequencies, s, from those of one speed, and of backbone curves; crossings cost a few more. Absent while the reduction is
    /// to be computed or where that speed has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub computing_time_s: Option<f64>,
    /// Computing time of backbone curves alone, s. Absent without them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backbones_time_s: Option<f64>,
    /// Modes that the stored reductions choose for the accuracy asked for; absent until they do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<ModesChoice>,
    /// Warnings about numbers that cannot be relied on: a K(Ω) that cannot be trusted between the speeds at which the stiffness is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The whole request as resolved, with the modes chosen in place of what was asked for.
    pub settings: ModalAnalysisRequest,
    /// Version of the code.
    pub version: String,
}

/// Plan of branches: what they will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchesPlan {
    /// Every effect a scene may name, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Symmetry of the scene.
    pub symmetry: FoundSymmetry,
    /// Pairs of contact node and casing; see the plan of a sweep.
    pub contact_pairs: u64,
    /// Whether the reduction that the branches rest on is stored. While it is not, `point` and `estimate` are left out.
    pub reduction: ReductionState,
    /// Largest number of real unknowns of the whole reduced wheel; see the plan of a sweep.
    pub reduced_unknowns_at_most: u64,
    /// Largest size of the basis of a reduction that has still to be computed, bytes of disk; see the plan of a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub basis_bytes_at_most: Option<u64>,
    /// Machine whose steps were measured for the times of this plan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<Machine>,
    /// Number of points of the branch through the response at `speed`, if it goes straight to both ends of the range. Where the branch turns back,
    /// and where responses change fast, there are more.
    pub points_at_least: u32,
    /// Largest number of points of the branch through the response at `speed`: `most_points` on either side. Branches of doubled period may have as
    /// many again.
    pub points_at_most: u32,
    /// Cost of a point, where the branches begin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<PlannedResponse>,
    /// Cost of a branch of `points_at_least` points, by one worker; `steps` are those of a march that takes as long as the upper bound of its time.
    /// Absent where `point` cannot be integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    /// Warnings about numbers that cannot be relied on: a K(Ω) that cannot be trusted between the speeds at which the stiffness is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The whole request as resolved.
    pub settings: BranchesSettings,
    /// Version of the code.
    pub version: String,
}

/// Plan of a point of a branch.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PlannedResponse {
    /// Reason for which the scene cannot be integrated where the branches begin or at an end of their range; all else is then absent or 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Real unknowns that are integrated.
    pub integrated_unknowns: u32,
    /// Scheme and step, and the reason that set them; the same along all branches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Steps per revolution.
    pub steps_per_revolution: u32,
    /// Computing time of a point, s, with the search between points: as long as 20 revolutions of a march take if nothing touches, and as 260 if
    /// something always does. Lightly damped responses take more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub computing_time_s: Option<CostRange>,
}

/// Effect that a scene may name, on or off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PlannedEffect {
    /// Name of the effect: its field in the scene.
    pub name: String,
    /// Whether the scene names the effect.
    pub on: bool,
    /// Description of what the effect adds to a run; absent where the effect is off, as is its cost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adds: Option<String>,
}
