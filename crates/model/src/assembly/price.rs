//! Estimate of the cost of making a package of a meshed sector, before it is made.

use serde::Serialize;

use super::dofs::SectorDofs;
use super::memory::assembly_bytes;
use super::pattern::Pattern;
use super::sector::MeshedSector;

/// Bytes of each stiffness matrix in a package (compressed arrays) for each pair of coupled displacements.
const STIFFNESS_BYTES: f64 = 8.25;

/// Bytes of the mass matrix in a package for each pair of coupled displacements.
const MASS_BYTES: f64 = 4.7;

/// Bytes of the gyroscopic matrix in a package for each pair of coupled displacements.
const GYROSCOPIC_BYTES: f64 = 3.6;

/// Seconds from mesh to package for each pair of coupled displacements, on two cores.
const SECONDS: f64 = 2.0e-6;

/// Number of stiffness matrices of a package.
const STIFFNESSES: f64 = 3.0;

/// Estimated cost of making the model of a mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct AssemblyPrice {
    /// Number of free displacements of the sector, those of the high face left out.
    pub unknowns: usize,
    /// Memory at the peak, bytes.
    pub memory_bytes: u64,
    /// Time on two cores, seconds.
    pub seconds: f64,
    /// Size of the package, bytes.
    pub package_bytes: u64,
}

/// Cost of making the package of a sector, from rates that were measured with the elements of the presets `small` to `paper`.
pub fn assembly_price(sector: &MeshedSector, gyroscopic: bool) -> AssemblyPrice {
    let dofs = SectorDofs::new(sector);
    let pairs = Pattern::new(&sector.mesh.elements, &dofs.rows, dofs.list.len()).len() as f64;
    let bytes = STIFFNESSES * STIFFNESS_BYTES + MASS_BYTES + if gyroscopic { GYROSCOPIC_BYTES } else { 0.0 };
    AssemblyPrice {
        unknowns: dofs.own,
        memory_bytes: assembly_bytes(sector),
        seconds: SECONDS * pairs,
        package_bytes: (bytes * pairs) as u64,
    }
}
