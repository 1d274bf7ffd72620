//! Verdict on a sweep: whether the wheel may run in its operating ranges.

use std::cmp::Ordering;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::digits::{digits, percent};
use crate::request::{Limits, SweepRequest};
use crate::result::tip::TipResponse;
use rubmap_wheel::dynamics::sector::Units;

/// Verdict on a sweep by the operating ranges and the limits of its request. The rules are in docs/reading-results.md.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SweepVerdict {
    /// Verdict on the sweep: the worst of its ranges.
    pub verdict: VerdictWord,
    /// Verdict in words: range, speed, limit, and by how much.
    pub sentence: String,
    /// Whether the request gives operating ranges; otherwise `ranges` has one without a name, from the slowest to the fastest speed of the sweep.
    pub ranges_given: bool,
    /// Verdicts on the ranges, in the order of the request.
    pub ranges: Vec<RangeVerdict>,
    /// Critical speeds of the wheel (over all contact nodes, components and blades) against ranges and limits, the most severe first.
    pub critical_speeds: Vec<JudgedSpeed>,
    /// The three worst speeds, of each peak one: of critical speeds and those with the largest values inside a range, those closest to a limit or
    /// farthest above it; without limits the most severe critical speeds.
    #[cfg_attr(feature = "schema", schema(max_items = 3))]
    pub worst: Vec<JudgedSpeed>,
    /// Ways to turn an undecided verdict into a decision; also listed beside `act`, which stands without them.
    pub would_decide: Vec<OpenQuestion>,
    /// Units of the model.
    pub units: Units,
    /// The whole request as resolved.
    pub settings: SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// Verdict in one word, in ascending order of concern.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum VerdictWord {
    /// Every limit is kept with a margin, no critical speed was found near, and nothing is open.
    Clear,
    /// Every limit is kept, but one is reached to 80 % or more, or a critical speed lies inside the range or within its separation.
    Watch,
    /// Something is open behind which a passed limit may hide.
    Undecided,
    /// A limit is passed by more than the error, or the motion grows beyond all bounds.
    Act,
}

impl VerdictWord {
    /// Name of the verdict on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Watch => "watch",
            Self::Undecided => "undecided",
            Self::Act => "act",
        }
    }

    /// Verdict of this name; `None` if there is no such verdict.
    pub fn named(name: &str) -> Option<Self> {
        [Self::Clear, Self::Watch, Self::Undecided, Self::Act].into_iter().find(|word| word.as_str() == name)
    }
}

impl fmt::Display for VerdictWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// Verdict on one range of speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RangeVerdict {
    /// Name of the range; absent where the request gives none and the whole sweep is judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Verdict on the range.
    pub verdict: VerdictWord,
    /// Lowest speed of the range, rad/s.
    pub from_rad_s: f64,
    /// Highest speed of the range, rad/s.
    pub to_rad_s: f64,
    /// Asked distance of critical speeds from the ends, in per cent of the end's speed. Limits count within it, too.
    pub separation_percent: f64,
    /// Number of speeds inside the range or within its separation that were completed.
    pub speeds: u32,
    /// Indices of the speeds there that have no result yet.
    pub missing: Vec<u32>,
    /// Indices of the speeds there that could not be computed.
    pub failed: Vec<u32>,
    /// Indices of the speeds there whose motion grew beyond all bounds.
    pub diverged: Vec<u32>,
    /// Worst value there for each limit of the request.
    pub limits: Vec<WorstValue>,
    /// Number of critical speeds of the wheel inside the range.
    pub critical_inside: u32,
    /// Number of critical speeds of the wheel outside the range and within its separation.
    pub critical_within_separation: u32,
}

/// Largest value of one limit in a range, and its speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WorstValue {
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Rotational speed, rad/s.
    pub speed_rad_s: f64,
    /// Value against its limit.
    pub judged: JudgedValue,
}

/// Value of a speed against its limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct JudgedValue {
    /// Quantity that is limited.
    pub limit: LimitKind,
    /// Value at the speed.
    pub value: f64,
    /// Error v·e of the value v, which lies between v/(1 + e) and v (1 + e); absent where no control run gives an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Limit of the request.
    pub allowed: f64,
    /// How far the value lies above its limit, in per cent of the limit; negative below.
    pub above_percent: f64,
    /// Standing of the value against its limit.
    pub standing: Standing,
}

impl JudgedValue {
    /// Share of the limit that the value takes.
    pub(crate) fn share(&self) -> f64 {
        self.value / self.allowed
    }

    /// Value with the bounds that its error leaves it, where they are told apart by three digits: `1.45 (1.26 to 1.66)`.
    pub fn known_words(&self) -> String {
        let Some(error) = self.error.filter(|_| self.value > 0.0) else { return digits(self.value) };
        let factor = 1.0 + error / self.value;
        let [value, below, above] = [self.value, self.value / factor, self.value * factor].map(digits);
        if below == value && above == value { value } else { format!("{value} ({below} to {above})") }
    }

    /// Standing of the value in words: `kept, 20 % left`, `passed by 36 %`.
    pub fn standing_words(&self) -> String {
        let by = percent(self.above_percent.abs());
        let standing = match (self.standing, self.error) {
            (Standing::Passed, _) => return format!("passed by {by}"),
            (Standing::Kept | Standing::Reached, _) => "kept",
            (Standing::Open, Some(_)) => "within the error",
            (Standing::Open, None) => "error not known",
        };
        format!("{standing}, {by} {}", if self.above_percent > 0.0 { "above" } else { "left" })
    }

    /// Order of concern: by standing, then by share of the limit.
    pub(crate) fn concern(&self, other: &Self) -> Ordering {
        self.standing.cmp(&other.standing).then(self.share().total_cmp(&other.share()))
    }
}

/// Standing of a value against its limit. Where no error is known, 20 % of the limit on either side is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Below 80 % of the limit, and below it by more than the error.
    Kept,
    /// At 80 % of the limit or more, and below it by more than the error.
    Reached,
    /// Closer to the limit than the error.
    Open,
    /// Above the limit by more than the error.
    Passed,
}

/// Quantity that a request limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum LimitKind {
    /// Largest outward displacement of a tip over its running clearance.
    ClearanceConsumption,
    /// Largest half peak-to-peak displacement of all tips.
    TipMotion,
    /// Utilisation of the material.
    Utilisation,
    /// Largest contact force on a node.
    NodeForce,
}

impl LimitKind {
    /// Quantities in the order in which requests list their limits.
    pub const ALL: [Self; 4] =
        [Self::ClearanceConsumption, Self::TipMotion, Self::Utilisation, Self::NodeForce];

    /// Limit of the quantity among those of a request.
    pub fn limit(self, limits: &Limits) -> Option<f64> {
        match self {
            Self::ClearanceConsumption => limits.clearance_consumption,
            Self::TipMotion => limits.tip_motion,
            Self::Utilisation => limits.utilisation,
            Self::NodeForce => limits.node_force,
        }
    }

    /// Name of the quantity on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::ClearanceConsumption => "clearance_consumption",
            Self::TipMotion => "tip_motion",
            Self::Utilisation => "utilisation",
            Self::NodeForce => "node_force",
        }
    }

    /// Name of the limit in sentences.
    pub fn words(self) -> &'static str {
        match self {
            Self::ClearanceConsumption => "clearance consumption",
            Self::TipMotion => "tip motion",
            Self::Utilisation => "utilisation",
            Self::NodeForce => "contact force on a node",
        }
    }

    /// Unit of the limit; empty for a share.
    pub fn unit(self, units: &Units) -> &str {
        match self {
            Self::ClearanceConsumption | Self::Utilisation => "",
            Self::TipMotion => &units.length,
            Self::NodeForce => &units.force,
        }
    }
}

/// Speed against ranges and limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct JudgedSpeed {
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Rotational speed, rad/s.
    pub speed_rad_s: f64,
    /// Whether the speed is a critical speed of the wheel.
    pub critical: bool,
    /// Whether the neighbouring speeds resolve the peak; absent where the speed is no peak.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resolved: Option<bool>,
    /// How far the true peak may be from `speed_rad_s`, rad/s; absent where the speed is no peak.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_error_rad_s: Option<f64>,
    /// Tip that moves most at the speed; absent for speeds that an earlier version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<TipResponse>,
    /// Engine order of the largest amplitude, at the sensor that moves most; absent where no line stands out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub engine_order: Option<f64>,
    /// Nodal diameter that carries the engine order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nodal_diameter: Option<u32>,
    /// Positions of the speed against the ranges of the request, in their order; empty where it gives none.
    pub ranges: Vec<RangePosition>,
    /// Values of the speed against the limits of the request, as far as they are known.
    pub limits: Vec<JudgedValue>,
}

/// Position of a speed against a range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct RangePosition {
    /// Name of the range.
    pub range: String,
    /// Position against the range.
    pub position: Position,
    /// Distance from the nearer end of the range in per cent of the end's speed; negative inside.
    pub distance_percent: f64,
}

/// Position of a speed against a range and its separation; ends belong to what they end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Position {
    /// Inside the range.
    Inside,
    /// Outside the range, closer to it than the asked separation.
    WithinSeparation,
    /// Outside the range and its separation.
    Outside,
}

/// Question that is open, and what would decide it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct OpenQuestion {
    /// Kind of the question.
    pub what: OpenKind,
    /// Name of the range; absent where the question concerns no named range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<String>,
    /// Indices of the speeds that the question concerns; empty where it concerns none in particular.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub speeds: Vec<u32>,
    /// Finding in words.
    pub finding: String,
    /// Way to a decision in words.
    pub remedy: String,
}

/// Kind of an open question.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum OpenKind {
    /// No limit is given.
    NoLimit,
    /// The speeds of the sweep do not cover the range.
    RangeNotCovered,
    /// Speeds have no result yet.
    SpeedsMissing,
    /// Speeds could not be computed.
    SpeedsFailed,
    /// Motions have not settled.
    NotSettled,
    /// K(Ω) is unsound.
    UnsoundStiffness,
    /// Response beyond linear theory.
    BeyondLinearTheory,
    /// Validity of linear theory could not be checked.
    LinearTheoryNotChecked,
    /// A limit lies within the error of a value.
    ErrorAcrossLimit,
    /// A value is within 20 % of its limit, and no error is known.
    ErrorUnknown,
    /// A limited quantity is not known.
    ValueUnknown,
    /// A peak is not resolved.
    PeakUnresolved,
    /// Nothing touches, and nothing else moves the wheel.
    NothingTouches,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_told_with_its_bounds_and_its_standing() {
        let of = |value: f64, error: Option<f64>, standing: Standing| {
            let judged = JudgedValue {
                limit: LimitKind::TipMotion,
                value,
                error,
                allowed: 1.25,
                above_percent: 100.0 * (value / 1.25 - 1.0),
                standing,
            };
            (judged.known_words(), judged.standing_words())
        };
        let told = |value: &str, standing: &str| (value.to_owned(), standing.to_owned());
        assert_eq!(of(1.0, None, Standing::Kept), told("1", "kept, 20 % left"));
        assert_eq!(of(1.2, Some(0.001), Standing::Reached), told("1.2", "kept, 4.0 % left"));
        // A seventh: 1.45 is one of 1.27 to 1.66.
        let error = Some(1.45 / 7.0);
        assert_eq!(of(1.45, error, Standing::Passed), told("1.45 (1.27 to 1.66)", "passed by 16 %"));
        assert_eq!(
            of(1.3, Some(0.13), Standing::Open),
            told("1.3 (1.18 to 1.43)", "within the error, 4.0 % above")
        );
        assert_eq!(of(1.2, None, Standing::Open).1, "error not known, 4.0 % left");
        assert_eq!(of(0.0, Some(0.0), Standing::Kept), told("0", "kept, 100 % left"));
    }
}
