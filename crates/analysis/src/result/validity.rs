//! Whether linear theory still holds at a speed.

use serde::{Deserialize, Serialize};

/// Verdict on whether the response is small enough for the theory that it was computed by, and the numbers behind the verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Validity {
    /// Worst verdict of `checks`; `not_checked` where that would be `linear` and a measure that decides is in `lacking`.
    pub verdict: ValidityVerdict,
    /// Every number that was checked, the worst first; numbers that a model cannot give are not among them.
    pub checks: Vec<ValidityCheck>,
    /// Numbers that decide and could not be checked, each with the reason.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lacking: Vec<ValidityLack>,
}

impl Validity {
    /// Measures that are lacking, without the reasons.
    pub fn measures_lacking(&self) -> Vec<ValidityMeasure> {
        self.lacking.iter().map(|lack| lack.what).collect()
    }
}

/// A measure that could not be checked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ValidityLack {
    /// Measure that could not be checked.
    pub what: ValidityMeasure,
    /// Reason for which the measure could not be checked, in words.
    pub reason: String,
}

/// How far linear theory holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ValidityVerdict {
    /// Linear theory holds.
    Linear,
    /// Not checked: nothing speaks against linear theory, and a deciding measure in `lacking` could not be evaluated.
    NotChecked,
    /// Doubtful: numbers are to be taken with care.
    Doubtful,
    /// Beyond linear theory: numbers say that something large happens, not how large.
    Beyond,
}

/// One measure beside its limits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ValidityCheck {
    /// Measure that was checked.
    pub what: ValidityMeasure,
    /// Value of the measure, without unit.
    pub value: f64,
    /// Limit above which linear theory is doubtful.
    pub doubtful_above: f64,
    /// Limit above which the response is beyond linear theory; absent for guesses by geometry, which are never worse than doubtful.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond_above: Option<f64>,
    /// Index of the speed whose measured motion the value is scaled from; absent where the value is the speed's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scaled_from: Option<u32>,
}

impl ValidityCheck {
    /// Whether the value is above the limit of doubt.
    pub(crate) fn is_doubtful(&self) -> bool {
        self.value > self.doubtful_above
    }

    /// Verdict by this measure alone.
    pub fn verdict(&self) -> ValidityVerdict {
        if self.beyond_above.is_some_and(|limit| self.value > limit) {
            ValidityVerdict::Beyond
        } else if self.is_doubtful() {
            ValidityVerdict::Doubtful
        } else {
            ValidityVerdict::Linear
        }
    }
}

/// Measure of how far linear theory holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ValidityMeasure {
    /// Excess energy |κ| of the sector that moves most, at the instant of its largest motion, over its linear energy: under Green–Lagrange strain,
    /// once everything has relaxed that carries no motion; of a model with a mesh.
    ExcessEnergy,
    /// Second-order change of a contact node's distance to the casing over its clearance, at the instant of `excess_energy`.
    SecondOrderGap,
    /// Share of the linear motion of the contact nodes that the coordinates of blades that bend far do not carry, root mean square.
    OutsideCoordinates,
    /// Largest displacement of a contact node, mean included, over the smallest thickness of the blade at its tip; of a model with a
    /// mesh.
    DisplacementOverThickness,
    /// Largest displacement of a contact node, mean included, over the length of the contact line.
    DisplacementOverChord,
    /// Largest rotation of the line between two neighbouring contact nodes, rad.
    Rotation,
    /// Largest von Mises stress over yield strength.
    StressOverYield,
    /// Tangential approach of the same contact nodes of neighbouring blades, over the distance between them.
    NeighbourApproach,
    /// Largest tangential displacement of a contact node over the length of a lobe of the casing at the smallest radius of the contact line: for
    /// equal lobes their distance, for other shapes the length of a wave whose eighth is the narrowest width.
    ContactOverLobe,
}
