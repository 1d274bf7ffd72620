//! Centrifugal pre-stress of the wheel: a linear solution on the cyclic sector for nodal diameter 0.

use faer::MatMut;
use nalgebra::Vector3;
use rayon::prelude::*;
use rubmap_numerics::sparse_cholesky::{NotPositiveDefinite, SparseCholesky, SymbolicFactor};
use rubmap_solid::integrals;
use rubmap_solid::material::Stress;
use rubmap_solid::stress::point_stress;

use super::dofs::SectorDofs;
use super::pattern::Pattern;
use super::sector::MeshedSector;
use super::sum::Assembly;

/// Linear response of the wheel to its own centrifugal load at Ω = 1; everything scales with Ω².
#[derive(Debug, Clone)]
pub struct PreStress {
    /// Nodal displacements in (r, θ, z) components, per unit Ω².
    pub displacements: Vec<[f64; 3]>,
    /// Stresses of each element at its integration points, in x, y, z, per unit Ω².
    pub stresses: Vec<Vec<Stress>>,
}

/// Sector whose stiffness at rest has no Cholesky factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the sector's stiffness at rest is not positive definite: is anything clamped?")]
pub struct CanMove;

/// Solves `K_e u = f`, `f_a = ∫ ρ N_a r e_r dV`, with the high face tied to the low one in cylindrical
/// components and nodes on the axis moving along it.
///
/// # Errors
/// [`CanMove`] if the sector can move as a rigid body.
pub(super) fn solve(sector: &MeshedSector, dofs: &SectorDofs) -> Result<PreStress, CanMove> {
    let (numbering, nodes) = dofs.tied_rows(sector);
    let size = nodes.len();
    let assembly = Assembly::new(sector, &numbering);
    let origin = Vector3::from(sector.mesh.axis.0);
    let axis = sector.axis().direction();
    let mut solution = assembly
        .load(size, |element| integrals::centrifugal_load(&element.mass(), &element.positions, origin, axis));

    let pattern = Pattern::new(&sector.mesh.elements, &numbering, size);
    let values = assembly.matrix(&pattern, |element, _| element.stiffness());
    let stiffness = pattern.into_lower_triangle(values);
    let symbolic = SymbolicFactor::new(stiffness.symbolic(), &nodes);
    let factor = SparseCholesky::new(&symbolic, &stiffness).map_err(|NotPositiveDefinite| CanMove)?;
    factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut solution, size, 1));

    let displacements: Vec<[f64; 3]> =
        numbering.iter().map(|rows| rows.map(|row| row.map_or(0.0, |row| solution[row]))).collect();
    let stress_of =
        |element| point_stress(&sector.mesh, element, &assembly.displacements(element, &displacements));
    let stresses = sector.mesh.elements.par_iter().map(stress_of).collect();
    Ok(PreStress { displacements, stresses })
}
