//! Stress at one speed of a sweep, and the margin that it leaves.

use serde::{Deserialize, Serialize};

/// Stress of the mesh's nodes over the last revolution, as the mean over the elements around a node; static stress of the centrifugal load
/// included. Nodes near the contact line are left out, where forces act on points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PointStress {
    /// The largest von Mises stress of all places, blades and instants.
    pub largest: StressPeak,
    /// The largest von Mises stress over yield strength of all places whose material has one; absent where none has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_over_yield: Option<f64>,
    /// Largest von Mises stress of the centrifugal load alone.
    pub largest_static: f64,
    /// The most utilised places by descending utilisation; without strengths those of the largest alternating stress.
    #[cfg_attr(feature = "schema", schema(max_items = 20))]
    pub cycles: Vec<StressCycle>,
    /// Nodes within this distance of a contact node are left out, in the model's unit of length.
    pub excluded_radius: f64,
    /// So many nodes of a sector are left out.
    pub excluded_nodes: u32,
    /// So many places of a sector were followed over all blades and instants; a bound rules the others out.
    pub followed_nodes: u32,
    /// What `utilisation` lacks, in words; absent where it is there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lacking: Option<String>,
}

/// The largest stress, and where and when it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StressPeak {
    /// Von Mises stress, in the model's units.
    pub von_mises: f64,
    /// Id of the node.
    pub node: u64,
    /// Its position in the first sector, x, y, z as in the package.
    pub position: [f64; 3],
    /// Blade.
    pub sector: u32,
    /// Revolutions since the start.
    pub revolution: f64,
}

/// How the stress of one place goes over a revolution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StressCycle {
    /// Id of the node.
    pub node: u64,
    /// Its position in the first sector, x, y, z as in the package.
    pub position: [f64; 3],
    /// Blade.
    pub sector: u32,
    /// Name of the element set whose strengths count.
    pub set: String,
    /// (max + min)/2 of the von Mises stress with the sign of the mean normal stress.
    pub mean: f64,
    /// (max − min)/2 of the same.
    pub alternating: f64,
    /// (max + min)/2 of the principal stress that is largest in magnitude.
    pub principal_mean: f64,
    /// (max − min)/2 of the same.
    pub principal_alternating: f64,
    /// Goodman: `alternating`/fatigue strength + `mean`/ultimate strength, a mean below 0 counted as 0; at 1 nothing is left. Absent
    /// without these strengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub utilisation: Option<f64>,
    /// Largest von Mises stress over yield strength; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_yield: Option<f64>,
}
