//! Wear of an abradable coating.

use serde::{Deserialize, Serialize};

use rubmap_wheel::dynamics::contact::coating::WornCoating;

/// Wear of an abradable coating by the blades.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WearReport {
    /// Volume removed, length³.
    pub removed_volume: f64,
    /// Deepest wear, length.
    pub deepest: f64,
    /// Work that went into plastic strain, force·length.
    pub plastic_work: f64,
    /// Whether a tip met the metal behind the coating.
    pub reached_metal: bool,
}

impl WearReport {
    pub(crate) fn of(coating: &WornCoating) -> Self {
        Self {
            removed_volume: coating.removed_volume(),
            deepest: coating.worn_depths().into_iter().flatten().fold(0.0, f64::max),
            plastic_work: coating.plastic_work(),
            reached_metal: coating.reached_metal(),
        }
    }
}

/// Wear map: how deep the blades wore an abradable coating.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WearMap {
    /// Worn depths, `[rod][contact node]`, length: rods in the direction of rotation from the package's x axis, contact nodes from the leading edge.
    pub depths: Vec<Vec<f64>>,
}

impl WearMap {
    pub(crate) fn of(coating: &WornCoating) -> Self {
        Self { depths: coating.worn_depths() }
    }
}
