//! Branches of periodic responses.

use serde::{Deserialize, Serialize};

use crate::request::{BranchParameter, BranchesSettings, SchemeChoice, Sensor};
use crate::result::steady::{FloquetMultiplier, Stability};
use rubmap_wheel::dynamics::sector::Units;

/// Periodic responses, followed while a number of their scene changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Branches {
    /// What they have in common.
    #[serde(flatten)]
    pub head: BranchesHead,
    /// Whether all of them were followed to their ends; otherwise the job is still at it, or was stopped.
    pub complete: bool,
    /// The branch on which the search ended, then those of doubled period.
    pub branches: Vec<BranchTrack>,
}

/// What branches have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchesHead {
    /// What changes along them.
    pub parameter: BranchParameter,
    /// Whose amplitudes are told.
    pub sensors: Vec<Sensor>,
    /// How time is stepped, everywhere.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates, everywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_modes: Option<u32>,
    /// Steps per revolution, everywhere.
    pub steps_per_revolution: u32,
    /// Units of lengths.
    pub units: Units,
    /// What was asked for, with every default filled in.
    pub settings: BranchesSettings,
    /// Version of the program.
    pub version: String,
    /// Kind of vectors of the processor.
    pub vectors: String,
}

/// A branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchTrack {
    /// Which it is.
    #[serde(flatten)]
    pub track: Track,
    /// Its points, in the order of the branch.
    pub points: Vec<BranchPoint>,
    /// Where it turns back or changes its stability, in the same order.
    pub bifurcations: Vec<Bifurcation>,
    /// Critical values: maxima of a sensor's amplitude along the branch, those of each sensor in the same order.
    pub maxima: Vec<BranchMaximum>,
    /// Why it ends: at its first point, unless it begins there, and at its last.
    pub ends: Vec<BranchEnd>,
}

/// Which branch something is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Track {
    /// Its number among the branches, from 0.
    pub branch: u32,
    /// Passages of a lobe after which its motions repeat; absent of those that repeat as their scene does: after the shortest time
    /// that its symmetry allows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobe_passages: Option<u32>,
    /// The flip from which it comes, by the number of the branch (`branch`, no place in a list) and the value there; absent of the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubles: Option<(u32, f64)>,
}

/// A periodic response.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchPoint {
    /// Value of the parameter: a speed in rad/s, otherwise a multiple of what the scene says.
    pub value: f64,
    /// Rotational speed.
    pub speed_rad_s: f64,
    /// Half the peak-to-peak displacement of every sensor.
    pub half_peak_to_peak: Vec<f64>,
    /// Whether it lasts, by its multipliers.
    pub stability: Stability,
    /// The largest multipliers, largest first.
    pub multipliers: Vec<FloquetMultiplier>,
    /// Passages of a lobe which they are of.
    pub lobe_passages: u32,
    /// ‖P(x) − x‖ / ‖x‖.
    pub residual: f64,
    /// Steps of Newton's method.
    pub newton_steps: u32,
    /// Revolutions of the wheel that it took.
    pub revolutions: f64,
}

/// Where a branch turns back or changes its stability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Bifurcation {
    /// What happens.
    pub kind: BifurcationKind,
    /// Value of the parameter.
    pub value: f64,
    /// Rotational speed.
    pub speed_rad_s: f64,
    /// How far from there it may be, in the unit of `value`.
    pub error: f64,
    /// Half the peak-to-peak displacement of every sensor there.
    pub half_peak_to_peak: Vec<f64>,
    /// The leading multiplier on the unstable side; absent of a fold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub multiplier: Option<FloquetMultiplier>,
    /// Modulus of the leading multiplier on the stable side: far below 1 where what touches changes, so that stability is lost at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_modulus: Option<f64>,
}

/// What happens to a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum BifurcationKind {
    /// It turns back: two responses meet and vanish, and the motion jumps.
    Fold,
    /// A multiplier passes −1: the period doubles.
    Flip,
    /// A pair of multipliers leaves the unit circle: a second frequency, and lines split.
    NeimarkSacker,
    /// A multiplier passes +1 without a fold: another branch of the same period, or of less symmetry, meets this one.
    Branching,
}

/// A maximum of a sensor's amplitude along a branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BranchMaximum {
    /// Index of the sensor.
    pub sensor: u32,
    /// Value of the parameter.
    pub value: f64,
    /// Rotational speed.
    pub speed_rad_s: f64,
    /// How far from there it may be, in the unit of `value`.
    pub error: f64,
    /// Half the peak-to-peak displacement.
    pub half_peak_to_peak: f64,
    /// Whether the response there lasts.
    pub stability: Stability,
}

/// Why a branch ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case", tag = "why")]
pub enum BranchEnd {
    /// It leaves the range.
    LeavesRange,
    /// It has as many points as were asked for.
    MostPoints,
    /// It comes back to the branch that it doubles.
    Joins,
    /// It could not be followed further.
    Lost {
        /// Why.
        reason: String,
    },
}

/// A stretch of a branch, as it is computed and stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchLeg {
    /// What all have in common.
    pub head: BranchesHead,
    /// Which branch it belongs to.
    pub track: Track,
    /// Whether it leads away from the beginning of the branch backwards.
    pub backwards: bool,
    /// Its points, away from the beginning.
    pub points: Vec<BranchPoint>,
    /// What was found among them.
    pub bifurcations: Vec<Bifurcation>,
    /// What was found among them.
    pub maxima: Vec<BranchMaximum>,
    /// Why the branch ends with it, if it does.
    pub end: Option<BranchEnd>,
    /// Whether nothing is left to follow.
    pub is_last: bool,
}

impl Branches {
    /// What the legs of a job make together, in the order in which they were computed; none of no legs.
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
    /// Whether both are of one kind, and where the one may be the other may be, too. A branch may turn back twice at nearly one value.
    pub(crate) fn is_same_as(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.kind != BifurcationKind::Fold
            && (self.value - other.value).abs() <= self.error + other.error
    }

    /// Extends its error over all places where the other may be.
    fn reach(&mut self, other: &Self) {
        self.error = self.error.max((self.value - other.value).abs() + other.error);
    }
}
