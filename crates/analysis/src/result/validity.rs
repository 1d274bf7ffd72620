//! Whether linear theory still holds at a speed.

use serde::{Deserialize, Serialize};

/// Whether the response is small enough for the theory that it was computed by, and the numbers that say so.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Validity {
    /// The worst of `checks`; what is `lacking` may say otherwise.
    pub verdict: ValidityVerdict,
    /// Every number that was looked at, the worst first; what a model cannot tell is not among them.
    pub checks: Vec<ValidityCheck>,
    /// Numbers that decide and could not be looked at: without them a verdict of `linear` says less than it could.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lacking: Vec<ValidityLack>,
}

impl Validity {
    /// What is lacking, without the reasons.
    pub fn measures_lacking(&self) -> Vec<ValidityMeasure> {
        self.lacking.iter().map(|lack| lack.what).collect()
    }
}

/// A number that was not looked at.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ValidityLack {
    /// What it is.
    pub what: ValidityMeasure,
    /// Why, in words.
    pub reason: String,
}

/// How far linear theory holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ValidityVerdict {
    /// It holds.
    Linear,
    /// Numbers are to be taken with care.
    Doubtful,
    /// The response has left it: numbers say that something large happens, not how large.
    Beyond,
}

/// One number beside its limits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ValidityCheck {
    /// What it is.
    pub what: ValidityMeasure,
    /// Its value, without unit.
    pub value: f64,
    /// Above this it is doubtful.
    pub doubtful_above: f64,
    /// Above this it is beyond linear theory.
    pub beyond_above: f64,
}

impl ValidityCheck {
    /// What this number alone says.
    pub fn verdict(&self) -> ValidityVerdict {
        if self.value > self.beyond_above {
            ValidityVerdict::Beyond
        } else if self.value > self.doubtful_above {
            ValidityVerdict::Doubtful
        } else {
            ValidityVerdict::Linear
        }
    }
}

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ValidityMeasure {
    /// Largest displacement of a contact node, mean included, over the smallest thickness of the blade at its tip; of a model with a
    /// mesh.
    DisplacementOverThickness,
    /// The same displacement over the length of the contact line.
    DisplacementOverChord,
    /// Largest rotation of the line between two neighbouring contact nodes, rad.
    Rotation,
    /// Largest von Mises stress over yield strength.
    StressOverYield,
    /// How far the same contact nodes of neighbouring blades come closer tangentially, over the distance between them.
    NeighbourApproach,
    /// Largest tangential displacement of a contact node over the length of a lobe of the casing at the smallest radius of the contact
    /// line: the distance of equal lobes, of other shapes that of a wave whose eighth is the narrowest of them.
    ContactOverLobe,
}
