//! Named parameter sets of impellers.

use serde::{Deserialize, Serialize};

use super::mesh::ElementOrder;
use super::parameters::{ImpellerParameters, MeshDensities, Splitter};

/// Named complete parameter set; all are the same titanium wheel of ten sectors with ten contact nodes each.
///
/// At Ω1 the largest von Mises stress is 460 to 750 N/mm², where the bore's clamp ends at the back face, and grows with
/// the mesh there; Ti-6Al-4V yields at some 830.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum), value(rename_all = "snake_case"))]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Main blades alone, 8-node elements, some 3,000 DOF a sector: the demo's impeller and the default.
    #[default]
    Small,
    /// Main and splitter blades, 20-node elements, some 20,000 DOF a sector.
    Medium,
    /// Main and splitter blades, 20-node elements, some 120,000 DOF a sector: the size of the paper's model.
    Paper,
}

impl Preset {
    /// Parameters of the preset.
    pub fn parameters(self) -> ImpellerParameters {
        let quadratic = |mesh| ImpellerParameters {
            splitter: Some(Splitter::default()),
            element_order: ElementOrder::Quadratic,
            mesh,
            ..ImpellerParameters::default()
        };
        match self {
            Self::Small => ImpellerParameters::default(),
            Self::Medium => quadratic(MeshDensities {
                between_contact_nodes: 2,
                blade_height: 6,
                blade_thickness: 1,
                half_passage: 3,
                disk: 5,
            }),
            Self::Paper => quadratic(MeshDensities {
                between_contact_nodes: 5,
                blade_height: 16,
                blade_thickness: 2,
                half_passage: 4,
                disk: 7,
            }),
        }
    }
}

/// Casing of the paper about an impeller: there (Methodology) given as fractions of the blade's height at the trailing edge, here as
/// lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperCasing {
    /// Clearance at the leading edge: 3 %.
    pub leading_clearance: f64,
    /// Clearance at the trailing edge: 2.2 %.
    pub trailing_clearance: f64,
    /// Height of the restriction, the same along the chord: 4.25 %.
    pub restriction: f64,
}

impl PaperCasing {
    /// Casing for an impeller, in its unit of length.
    pub fn of(parameters: &ImpellerParameters) -> Self {
        let percent = |share: f64| parameters.outlet_blade_height * share / 100.0;
        Self { leading_clearance: percent(3.0), trailing_clearance: percent(2.2), restriction: percent(4.25) }
    }
}
