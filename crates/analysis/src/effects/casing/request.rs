//! Casing, as it is asked for.

use serde::{Deserialize, Serialize};

use super::curves::Curves;

/// Casing of revolution, and what stands inward of it: the heights of all shapes that are given add up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Casing {
    /// Clearance along the chord.
    pub clearance: Clearance,
    /// Lobes of the restriction; absent: the casing is circular.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobes: Option<Lobes>,
    /// Single lobes and hollows, each of its own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 100))]
    pub single_lobes: Vec<SingleLobe>,
    /// Fourier series around the circumference.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 100))]
    pub waves: Vec<Wave>,
    /// Measured shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// Tilt: a casing whose axis leans. A casing whose axis is displaced is an `orbit` that does not whirl.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tilt: Option<Tilt>,
}

/// Clearance in the model's unit of length: `leading` and `trailing` (linear in the arc length through the contact nodes), or `values`, one per
/// contact node. Negative where the casing is pressed into the tips; the pressing grows over the ramp.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Clearance {
    /// Clearance at the leading edge (contact node 0).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leading: Option<f64>,
    /// Clearance at the trailing edge (last contact node).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trailing: Option<f64>,
    /// Clearances, one per contact node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub values: Option<Vec<f64>>,
    /// State of the wheel in which the clearances are given.
    #[serde(default, skip_serializing_if = "ClearanceState::is_running")]
    pub given: ClearanceState,
}

/// State of the wheel in which its clearances are given.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ClearanceState {
    /// Turning wheel: clearances are the same at every speed.
    #[default]
    Running,
    /// Wheel at rest: at every speed clearances are smaller by as much as the tips have grown under the centrifugal load, by the static solution with
    /// the same K(Ω). The package must have its elements.
    Cold,
}

impl ClearanceState {
    fn is_running(&self) -> bool {
        *self == Self::Running
    }
}

/// Equal Gaussian lobes, evenly spaced in the fixed frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Lobes {
    /// Number of lobes, at least 1.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub count: u32,
    /// Height A of a lobe, in the model's unit of length; at most a tenth of the radius at which the tips lie.
    pub amplitude: f64,
    /// Half-width w in exp(−(φ/w)²), rad; at most √2π/`count`, from where there is no valley between two lobes.
    pub width_rad: f64,
    /// Angle of the first lobe from the package's x axis, rad.
    #[serde(default)]
    pub phase_rad: f64,
    /// Share of the height at each contact node; absent: the whole height all along the chord.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub along_chord: Option<Vec<f64>>,
}

/// One Gaussian lobe A exp(−(φ/w)²) in the fixed frame; a hollow if A is negative.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct SingleLobe {
    /// Angle of the crest from the package's x axis, rad.
    pub angle_rad: f64,
    /// Height A, in the model's unit of length.
    pub amplitude: f64,
    /// Half-width w, rad; at most π/√2.
    pub width_rad: f64,
    /// Share of the height at each contact node; absent: the whole height all along the chord.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub along_chord: Option<Vec<f64>>,
}

/// Wave A cos(order (φ − phase)) in the fixed frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Number of waves around the circumference.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub order: u32,
    /// Height A of a crest, in the model's unit of length.
    pub amplitude: f64,
    /// Angle of a crest from the package's x axis, rad.
    #[serde(default)]
    pub phase_rad: f64,
    /// Share of the height at each contact node; absent: the whole height all along the chord.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub along_chord: Option<Vec<f64>>,
}

/// Measured heights inward of the casing of revolution, on lines around the circumference: periodic cubic splines around, linear from line to line
/// along the chord. Every point counts; the plan says what stands out of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// Angles from the package's x axis, rad, ascending within one turn, none farther than a quarter of a turn from the next.
    #[cfg_attr(feature = "schema", schema(min_items = 8, max_items = 100_000))]
    pub angles_rad: Vec<f64>,
    /// Place of every line along the chord, the share of the arc length through the contact nodes: 0 at the leading edge, 1 at the trailing edge,
    /// ascending. Nodes before the first line have its heights, nodes behind the last line those of the last. Absent: a line for every contact node,
    /// its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 8192))]
    pub chord: Option<Vec<f64>>,
    /// Heights, `[line][angle]`, in the model's unit of length; negative outward of the casing of revolution.
    pub heights: Vec<Vec<f64>>,
    /// Curves through the heights, once made.
    #[serde(skip)]
    #[cfg_attr(feature = "schema", schema(ignore))]
    pub curves: Curves,
}

/// Tilt: a leaning axis, to first order in its angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Tilt {
    /// Angle by which the casing's axis leans from the wheel's, rad.
    pub angle_rad: f64,
    /// Angle from the package's x axis towards which the end of the casing's axis at larger z leans, rad.
    #[serde(default)]
    pub towards_rad: f64,
    /// z of the point about which the casing's axis leans, in the model's unit of length.
    #[serde(default)]
    pub about_z: f64,
}
