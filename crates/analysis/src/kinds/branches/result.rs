//! Branches of periodic responses.

use serde::{Deserialize, Serialize};

use crate::request::{BranchParameter, BranchesSettings, SchemeChoice, Sensor};
use crate::result::steady::{FloquetMultiplier, Stability};
use rubmap_wheel::dynamics::sector::Units;

/// Periodic responses, followed while a number of their scene changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Branches {
    /// Parameter, sensors, scheme, units and settings that all branches have in common.
    #[serde(flatten)]
    pub head: BranchesHead,
    /// Whether all branches were followed to their ends; otherwise the job is still running, or was stopped.
    pub complete: bool,
    /// Branches: first the one on which the search ended, then those of doubled period.
    pub branches: Vec<BranchTrack>,
}

/// Parameter, sensors, scheme, units and settings that all branches of a job have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchesHead {
    /// Number of the scene that changes along the branches.
    pub parameter: BranchParameter,
    /// Sensors whose amplitudes are reported.
    pub sensors: Vec<Sensor>,
    /// Time-stepping scheme, the same on all branches.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates, the same on all branches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_modes: Option<u32>,
    /// Steps per revolution, the same on all branches.
    pub steps_per_revolution: u32,
    /// Units of the model.
    pub units: Units,
    /// Request with every default filled in.
    pub settings: BranchesSettings,
    /// Version of the program.
    pub version: String,
    /// Kind of vector instructions of the processor: another kind may round differently.
    pub vectors: String,
}

/// A branch of periodic responses, with its bifurcations, maxima and ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchTrack {
    /// Number and origin of the branch.
    #[serde(flatten)]
    pub track: Track,
    /// Points of the branch, in its order.
    pub points: Vec<BranchPoint>,
    /// Places where the branch turns back or changes its stability, in the order of the branch.
    pub bifurcations: Vec<Bifurcation>,
    /// Critical values: maxima of a sensor's amplitude along the branch, those of each sensor in the order of the branch.
    pub maxima: Vec<BranchMaximum>,
    /// Reasons for which the branch ends: at its first point, unless the branch begins there, and at its last.
    pub ends: Vec<BranchEnd>,
}

/// Number of a branch, and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Track {
    /// Number of the branch among all branches, from 0.
    pub branch: u32,
    /// Passages of a lobe after which the motions of the branch repeat; absent for motions that repeat as their scene does, after the shortest time
    /// that its symmetry allows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobe_passages: Option<u32>,
    /// Flip from which the branch comes: number of the other branch (its `branch`, not an index into a list) and value of the parameter there; absent
    /// for the first branch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubles: Option<(u32, f64)>,
}

/// A periodic response on a branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchPoint {
    /// Value of the parameter: a speed in rad/s, otherwise a multiple of the number in the scene.
    pub value: f64,
    /// Rotational speed, rad/s.
    pub speed_rad_s: f64,
    /// Half the peak-to-peak displacement of every sensor.
    pub half_peak_to_peak: Vec<f64>,
    /// Stability of the response, by its multipliers.
    pub stability: Stability,
    /// Floquet multipliers of largest modulus, largest first.
    pub multipliers: Vec<FloquetMultiplier>,
    /// Passages of a lobe over which the multipliers are taken.
    pub lobe_passages: u32,
    /// Residual ‖P(x) − x‖ / ‖x‖ of the response x, P being the return map.
    pub residual: f64,
    /// Steps of Newton's method that the point took.
    pub newton_steps: u32,
    /// Revolutions of the wheel that the point took.
    pub revolutions: f64,
}

/// Place where a branch turns back or changes its stability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Bifurcation {
    /// Kind of the bifurcation.
    pub kind: BifurcationKind,
    /// Value of the parameter at the bifurcation: a speed in rad/s, otherwise a multiple of the number in the scene.
    pub value: f64,
    /// Rotational speed at the bifurcation, rad/s.
    pub speed_rad_s: f64,
    /// Error of `value`, in the same unit: how far from there the bifurcation may be.
    pub error: f64,
    /// Half the peak-to-peak displacement of every sensor at the bifurcation.
    pub half_peak_to_peak: Vec<f64>,
    /// Leading multiplier on the unstable side; absent for a fold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub multiplier: Option<FloquetMultiplier>,
    /// Modulus of the leading multiplier on the stable side: far below 1 where the set of touching nodes changes, so that stability is lost at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_modulus: Option<f64>,
}

/// Kind of a bifurcation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum BifurcationKind {
    /// Fold: the branch turns back; two responses meet and vanish, and the motion jumps.
    Fold,
    /// Flip: a multiplier passes −1, and the period doubles.
    Flip,
    /// Neimark–Sacker bifurcation: a pair of multipliers leaves the unit circle; a second frequency appears, and lines split.
    NeimarkSacker,
    /// Branching: a multiplier passes +1 without a fold; another branch of the same period, or of less symmetry, meets this one.
    Branching,
}

/// A maximum of a sensor's amplitude along a branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchMaximum {
    /// Index of the sensor.
    pub sensor: u32,
    /// Value of the parameter at the maximum: a speed in rad/s, otherwise a multiple of the number in the scene.
    pub value: f64,
    /// Rotational speed at the maximum, rad/s.
    pub speed_rad_s: f64,
    /// Error of `value`, in the same unit: how far from there the maximum may be.
    pub error: f64,
    /// Half the peak-to-peak displacement of the sensor at the maximum.
    pub half_peak_to_peak: f64,
    /// Stability of the response at the maximum.
    pub stability: Stability,
}

/// Reason for which a branch ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case", tag = "why")]
pub enum BranchEnd {
    /// End of the range: the branch leaves it.
    LeavesRange,
    /// Largest number of points: the branch has as many as were asked for.
    MostPoints,
    /// Junction: the branch comes back to the one that it doubles.
    Joins,
    /// Lost branch: it could not be followed further.
    Lost {
        /// Reason for which the branch was lost, in words.
        reason: String,
    },
}

/// Leg of a branch: a stretch of it, as it is computed and stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchLeg {
    /// Parameter, sensors, scheme, units and settings that all legs of the job have in common.
    pub head: BranchesHead,
    /// Branch that the leg belongs to.
    pub track: Track,
    /// Whether the leg leads backwards from the beginning of its branch.
    pub backwards: bool,
    /// Points of the leg, away from the beginning of the branch.
    pub points: Vec<BranchPoint>,
    /// Bifurcations found among the points of the leg.
    pub bifurcations: Vec<Bifurcation>,
    /// Maxima found among the points of the leg.
    pub maxima: Vec<BranchMaximum>,
    /// Reason for which the branch ends with this leg, if it does.
    pub end: Option<BranchEnd>,
    /// Whether nothing is left to follow after this leg.
    pub is_last: bool,
}

impl Branches {
    /// Joins the legs of a job, in the order in which they were computed, into branches; none without legs.
    pub fn of(legs: Vec<BranchLeg>) -> Option<Self> {
        let head = legs.first()?.head.clone();
        let mut branches = Vec::<BranchTrack>::new();
        let complete = legs.last().is_some_and(|leg| leg.is_last);
        for leg in legs {
            let BranchLeg { track, backwards, points, bifurcations, maxima, end, .. } = leg;
            let place = branches.iter().position(|branch| branch.track == track);
            let place = place.unwrap_or_else(|| {
                let (points, bifurcations, maxima, ends) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
                branches.push(BranchTrack { track, points, bifurcations, maxima, ends });
                branches.len() - 1
            });
            let branch = &mut branches[place];
            if backwards {
                branch.points.splice(0..0, points.into_iter().rev());
                branch.bifurcations.splice(0..0, bifurcations.into_iter().rev());
                branch.maxima.splice(0..0, maxima.into_iter().rev());
                branch.ends.splice(0..0, end);
            } else {
                branch.points.extend(points);
                branch.bifurcations.extend(bifurcations);
                branch.maxima.extend(maxima);
                branch.ends.extend(end);
            }
        }
        for branch in &mut branches {
            let found = std::mem::take(&mut branch.bifurcations);
            for bifurcation in found {
                match branch.bifurcations.iter_mut().rfind(|other| other.is_same_as(&bifurcation)) {
                    Some(same) => same.reach(&bifurcation),
                    None => branch.bifurcations.push(bifurcation),
                }
            }
        }
        Some(Self { head, complete, branches })
    }
}

impl Bifurcation {
    /// Whether two bifurcations of one kind may lie at the same place, by their errors. Folds never count as the same: a branch may turn back twice
    /// at nearly one value.
    pub(crate) fn is_same_as(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.kind != BifurcationKind::Fold
            && (self.value - other.value).abs() <= self.error + other.error
    }

    /// Extends the error of this bifurcation over all places where the other may be.
    fn reach(&mut self, other: &Self) {
        self.error = self.error.max((self.value - other.value).abs() + other.error);
    }
}
