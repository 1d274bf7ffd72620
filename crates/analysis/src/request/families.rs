//! Meaning of modal families.

use serde::{Deserialize, Serialize};

/// Meaning of a modal family, of which every nodal diameter has one mode. By `shape` it is the mode with the shape of that of this rank at rest,
/// followed over speed through crossings and sharp veerings; by `rank` the mode whose frequency has this rank at a speed, so that modes that cross
/// swap their families.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum FamiliesBy {
    /// Mode with the shape of that of this rank at rest, followed over speed through crossings and sharp veerings by modal assurance.
    #[default]
    Shape,
    /// Mode whose frequency has this rank at a speed, in ascending order: modes that cross swap their families there.
    Rank,
}

impl FamiliesBy {
    /// Whether families are followed, as they are unless ranks are asked for.
    pub(crate) fn is_shape(&self) -> bool {
        *self == Self::Shape
    }
}
