//! Plan of the generation of a model: its size and memory.

use serde::{Deserialize, Serialize};

use super::error::ImpellerError;
use super::parameters::ImpellerParameters;
use super::sector_mesh::impeller_sector;
use crate::assembly::{SectorDofs, assembly_bytes};

/// Plan of the generation of a model: its size and memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct GenerationPlan {
    /// Number of nodes of the sector's mesh.
    pub nodes: u64,
    /// Number of rows of the sector's matrices, those of the high cyclic face included.
    pub dofs: u64,
    /// Peak of the memory for generating the model, in bytes: the estimate with a quarter added for safety.
    pub memory_bytes: u64,
    /// Parameters of the model, as resolved.
    pub settings: ImpellerParameters,
}

/// Plans the generation of a model: meshes the sector, and does nothing more.
///
/// # Errors
/// [`ImpellerError`] names the parameter or the element at fault.
pub fn plan_generation(parameters: &ImpellerParameters) -> Result<GenerationPlan, ImpellerError> {
    let sector = impeller_sector(parameters)?.made_of(&parameters.material);
    Ok(GenerationPlan {
        nodes: sector.mesh.nodes.len() as u64,
        dofs: SectorDofs::new(&sector).list.len() as u64,
        memory_bytes: assembly_bytes(&sector),
        settings: parameters.clone(),
    })
}
