//! What generating a model will make and take.

use serde::{Deserialize, Serialize};

use super::dofs::SectorDofs;
use super::error::ImpellerError;
use super::memory::generation_bytes;
use super::parameters::ImpellerParameters;
use super::sector_mesh::impeller_sector;

/// What generating a model will make and take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct GenerationPlan {
    /// Nodes of the sector's mesh.
    pub nodes: u64,
    /// Rows of its matrices, those of the high cyclic face included.
    pub dofs: u64,
    /// Memory that it holds at most, a quarter of it for safety.
    pub memory_bytes: u64,
    /// All parameters, as resolved.
    pub settings: ImpellerParameters,
}

/// Meshes the sector, and no more.
///
/// # Errors
/// [`ImpellerError`] names the parameter or the element at fault.
pub fn plan_generation(parameters: &ImpellerParameters) -> Result<GenerationPlan, ImpellerError> {
    let sector = impeller_sector(parameters)?;
    Ok(GenerationPlan {
        nodes: sector.mesh.nodes.len() as u64,
        dofs: SectorDofs::new(&sector).list.len() as u64,
        memory_bytes: generation_bytes(&sector),
        settings: parameters.clone(),
    })
}
