//! What is found of the shape of a casing.

use serde::{Deserialize, Serialize};

use super::request::Measured;

/// The shape of a casing that is not one of revolution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FoundShape {
    /// It repeats so often around the circumference: parts together, at all contact nodes.
    pub repeats: u32,
    /// What steps have to see, rad: the narrowest half-width of a lobe, an eighth of the shortest wave, and of measured heights the
    /// half-width of a lobe as high as their range and as sharp as their sharpest bend. Absent of a tilt alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub narrowest_rad: Option<f64>,
    /// No height is larger, in the model's unit of length; absent where a tilt makes it a matter of the contact nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub highest: Option<f64>,
    /// What measured heights look like.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredSurvey>,
}

/// What stands out of measured heights; nothing is left out or changed because of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeasuredSurvey {
    /// How heights between the points are found.
    pub interpolation: String,
    /// Heights that stand alone, the farthest off first, at most a hundred.
    pub outliers: Vec<Outlier>,
    /// How many there are.
    pub outlier_count: u32,
    /// Angles without points, more than three times as wide as half of the others, the widest first, at most a hundred.
    pub gaps: Vec<AngularGap>,
    /// How many there are.
    pub gap_count: u32,
    /// Where the curve goes farthest beyond all heights of its line, as it does beside steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overshoot: Option<Overshoot>,
}

/// A table of measured heights, as requests take it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeasuredCasing {
    /// For `scene.casing.measured`.
    pub measured: Measured,
    /// What stands out of it.
    pub survey: MeasuredSurvey,
    /// Heights that a line did not have at an angle of another one, taken from its own curve, at most a hundred.
    pub filled: Vec<FilledHeight>,
    /// How many there are.
    pub filled_count: u32,
}

/// A height that was not measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FilledHeight {
    /// Index of its line.
    pub line: u32,
    /// Its angle, rad.
    pub angle_rad: f64,
    /// What the curve through the others says.
    pub height: f64,
}

/// A height far from the cubic through the two before and the two behind it, which its neighbours would fit without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Outlier {
    /// Index of its line.
    pub line: u32,
    /// Its angle, rad.
    pub angle_rad: f64,
    /// What was measured.
    pub height: f64,
    /// What its neighbours expect there.
    pub expected: f64,
}

/// Angles without points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct AngularGap {
    /// Last angle before it, rad.
    pub from_rad: f64,
    /// First angle behind it, rad; one turn more where it holds the end of the list.
    pub to_rad: f64,
}

/// A curve beyond its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Overshoot {
    /// Index of the line.
    pub line: u32,
    /// Where, rad.
    pub angle_rad: f64,
    /// By how much the curve is above the largest or below the smallest height of the line, in the model's unit of length.
    pub by: f64,
}
