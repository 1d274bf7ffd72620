//! Findings about the shape of a casing.

use serde::{Deserialize, Serialize};

use super::request::Measured;

/// Shape of a casing that is not one of revolution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FoundShape {
    /// Number of times that the shape repeats around the circumference, all parts together, at all contact nodes.
    pub repeats: u32,
    /// Width that steps have to resolve, rad: the narrowest half-width of a lobe, an eighth of the shortest wave, and for measured heights the
    /// half-width of a lobe as high as their range and as sharp as their sharpest bend. Absent for a tilt alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub narrowest_rad: Option<f64>,
    /// Upper bound of the height, in the model's unit of length; absent where a tilt makes it depend on the contact nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub highest: Option<f64>,
    /// Survey of the measured heights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredSurvey>,
}

/// Survey of measured heights: what stands out of them; nothing is left out or changed because of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeasuredSurvey {
    /// Interpolation of heights between the points, in words.
    pub interpolation: String,
    /// Outliers: heights that stand alone, the farthest off first, at most a hundred.
    pub outliers: Vec<Outlier>,
    /// Number of outliers, listed or not.
    pub outlier_count: u32,
    /// Gaps: angles without points, more than three times as wide as the median distance of angles, the widest first, at most a hundred.
    pub gaps: Vec<AngularGap>,
    /// Number of gaps, listed or not.
    pub gap_count: u32,
    /// Largest overshoot: where the curve goes farthest beyond all heights of its line, as it does beside steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overshoot: Option<Overshoot>,
}

/// Table of measured heights, as requests take it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeasuredCasing {
    /// Table for `scene.casing.measured`.
    pub measured: Measured,
    /// Survey of the table.
    pub survey: MeasuredSurvey,
    /// Filled heights: those that a line did not have at an angle of another line, taken from its own curve, at most a hundred.
    pub filled: Vec<FilledHeight>,
    /// Number of filled heights, listed or not.
    pub filled_count: u32,
}

/// Filled height: one that was not measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FilledHeight {
    /// Index of the line.
    pub line: u32,
    /// Angle of the height, rad.
    pub angle_rad: f64,
    /// Height of the curve through the other points of the line.
    pub height: f64,
}

/// Outlier: a height far from the cubic through the two before and the two behind it, while its neighbours would fit theirs without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Outlier {
    /// Index of the line.
    pub line: u32,
    /// Angle of the height, rad.
    pub angle_rad: f64,
    /// Height that was measured.
    pub height: f64,
    /// Height that the neighbours lead one to expect.
    pub expected: f64,
}

/// Gap: angles without points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct AngularGap {
    /// Last angle before the gap, rad.
    pub from_rad: f64,
    /// First angle behind the gap, rad; one turn more where the gap holds the end of the list.
    pub to_rad: f64,
}

/// Overshoot: a curve beyond its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Overshoot {
    /// Index of the line.
    pub line: u32,
    /// Angle of the overshoot, rad.
    pub angle_rad: f64,
    /// Height by which the curve is above the largest or below the smallest height of the line, in the model's unit of length.
    pub by: f64,
}
