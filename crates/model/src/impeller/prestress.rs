//! Centrifugal pre-stress of the wheel: a linear solution on the cyclic sector for nodal diameter 0.

use faer::MatMut;
use nalgebra::Vector3;
use rayon::prelude::*;

use super::assembly::Assembly;
use super::dofs::SectorDofs;
use super::element::{Hexahedron, Stress};
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::SectorMesh;
use super::pattern::Pattern;
use rubmap_numerics::sparse_cholesky::{NotPositiveDefinite, SparseCholesky, SymbolicFactor};

/// Linear response of the wheel to its own centrifugal load at Ω = 1; everything scales with Ω².
#[derive(Debug, Clone)]
pub struct PreStress {
    /// Nodal displacements in (r, θ, z) components, per unit Ω².
    pub displacements: Vec<[f64; 3]>,
    /// Stresses of each element at its Gauss points, in x, y, z, per unit Ω².
    pub stresses: Vec<Vec<Stress>>,
}

/// Solves `K_e u = f`, `f_a = ∫ ρ N_a r e_r dV`, with the high face tied to the low one in cylindrical
/// components.
///
/// # Errors
/// [`ImpellerError::NotPositiveDefinite`] if the sector can move as a rigid body.
pub(super) fn solve<E: Hexahedron<N>, const N: usize>(
    sector: &SectorMesh,
    elements: &[[usize; N]],
    dofs: &SectorDofs,
    material: &Material,
) -> Result<PreStress, ImpellerError> {
    let numbering = dofs.tied_rows(sector);
    let assembly = Assembly::new(&sector.mesh, elements, &numbering);
    let element = |e: usize| E::from(sector.mesh.positions(&elements[e]));
    let mut solution = assembly.load(dofs.own, |e| centrifugal_load(&element(e), material.density));

    let pattern = Pattern::new(elements, &numbering, dofs.own);
    let values = assembly.matrix(&pattern, |e| element(e).stiffness(material));
    let stiffness = pattern.into_lower_triangle(values);
    let nodes: Vec<usize> = dofs.list[..dofs.own].iter().map(|&(node, _)| node).collect();
    let symbolic = SymbolicFactor::new(stiffness.symbolic(), &nodes);
    let factor = SparseCholesky::new(&symbolic, &stiffness)
        .map_err(|NotPositiveDefinite| ImpellerError::NotPositiveDefinite)?;
    factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut solution, dofs.own, 1));

    let displacements: Vec<[f64; 3]> =
        numbering.iter().map(|rows| rows.map(|row| row.map_or(0.0, |row| solution[row]))).collect();
    let stresses = (0..elements.len())
        .into_par_iter()
        .map(|e| element(e).stresses(material, &assembly.displacements(e, &displacements)))
        .collect();
    Ok(PreStress { displacements, stresses })
}

/// Centrifugal load `f_a = Σ m_ab (x_b, y_b, 0)`, which is `∫ ρ N_a r e_r dV` at Ω = 1 exactly, since position is interpolated like
/// displacement.
fn centrifugal_load<E: Hexahedron<N>, const N: usize>(element: &E, density: f64) -> [Vector3<f64>; N] {
    let mass = element.mass(density);
    let x = element.positions();
    std::array::from_fn(|a| {
        x.iter().enumerate().map(|(b, x)| Vector3::new(x[0], x[1], 0.0) * mass[(a, b)]).sum()
    })
}
