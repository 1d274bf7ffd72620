//! Gyroscopic matrix `G_ab = 2 ∫ ρ N_a [e×] N_b dV`: Coriolis forces per unit speed.

use rubmap_solid::integrals;

use super::dofs::SectorDofs;
use super::pattern::Pattern;
use super::sector::MeshedSector;
use super::sum::Assembly;
use crate::package::raw::RawMatrix;

/// Assembles G from the consistent mass, in the rows of the sector's other matrices; skew-symmetric, lower triangle.
pub fn gyroscopic_matrix(sector: &MeshedSector) -> RawMatrix {
    let dofs = SectorDofs::new(sector);
    let pattern = Pattern::new(&sector.mesh.elements, &dofs.rows, dofs.list.len());
    let axis = sector.axis().direction();
    let assembly = Assembly::new(sector, &dofs.rows);
    let values = assembly.matrix(&pattern, |element, _| integrals::gyroscopic(&element.mass(), axis));
    let mut matrix = pattern.raw_matrix(|position| values[position]);
    // A node's own block is 2 m [e×] in any frame: the entries on its diagonal are round-off of the turn.
    matrix.entries.retain(|&(row, column, value)| row != column && value != 0.0);
    matrix
}
