//! Centrifugal pre-stress of the wheel: a linear solve on the cyclic sector for nodal diameter 0.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::LltError;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

use super::assembly::{SectorDofs, element_displacements, element_frame, element_rows, merged};
use super::element::{self, GaussStresses, Vector24};
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::SectorMesh;
use crate::package::raw::RawMatrix;

/// Linear answer of the wheel to its own centrifugal load at Ω = 1; everything scales with Ω².
#[derive(Debug, Clone)]
pub struct PreStress {
    /// Nodal displacements in (r, θ, z) components, per unit Ω².
    pub displacements: Vec<[f64; 3]>,
    /// Stresses per element at its Gauss points, per unit Ω².
    pub stresses: Vec<GaussStresses>,
}

/// Solves `K_e u = f`, `f_a = ∫ ρ N_a r e_r dV`, with the high face tied to the low one in cylindrical
/// components.
///
/// # Errors
/// [`ImpellerError::NotPositiveDefinite`] if the sector can move as a rigid body.
pub(super) fn solve(
    sector: &SectorMesh,
    dofs: &SectorDofs,
    material: &Material,
    elastic: &RawMatrix,
) -> Result<PreStress, ImpellerError> {
    let stiffness = folded(dofs, elastic)?;
    let load = centrifugal_load(sector, dofs, material);
    let solution = match stiffness.sp_cholesky(Side::Lower) {
        Ok(factor) => factor.solve(&load),
        Err(LltError::Numeric(_)) => return Err(ImpellerError::NotPositiveDefinite),
        Err(LltError::Generic(error)) => {
            return Err(ImpellerError::Factorisation { detail: format!("{error:?}") });
        }
    };
    let displacements: Vec<[f64; 3]> = dofs
        .rows
        .iter()
        .map(|rows| rows.map(|row| row.map_or(0.0, |row| solution[(dofs.folded[row], 0)])))
        .collect();
    let stresses = (0..sector.mesh.elements.len())
        .map(|e| {
            let u = element_displacements(sector, e, &displacements);
            element::stresses(&sector.mesh.corners(e), material, &u)
        })
        .collect();
    Ok(PreStress { displacements, stresses })
}

/// The stiffness of nodal diameter 0: rows and columns of the high face added onto the low face (lower triangle).
fn folded(dofs: &SectorDofs, matrix: &RawMatrix) -> Result<SparseColMat<usize, f64>, ImpellerError> {
    let mut entries = Vec::with_capacity(matrix.entries.len());
    for &(row, column, value) in &matrix.entries {
        let (a, b) = (dofs.folded[row as usize], dofs.folded[column as usize]);
        // An entry off the diagonal stands for its mirror too; both may fall on one diagonal entry.
        let value = if a == b && row != column { 2.0 * value } else { value };
        entries.push((a.max(b) as u32, a.min(b) as u32, value));
    }
    let triplets: Vec<_> =
        merged(entries).into_iter().map(|(r, c, v)| Triplet::new(r as usize, c as usize, v)).collect();
    SparseColMat::try_new_from_triplets(dofs.own, dofs.own, &triplets)
        .map_err(|error| ImpellerError::Factorisation { detail: format!("{error:?}") })
}

/// f = M (x, y, 0) at Ω = 1, which is `∫ ρ N_a r e_r dV` exactly for isoparametric elements, tied to the low
/// face.
fn centrifugal_load(sector: &SectorMesh, dofs: &SectorDofs, material: &Material) -> Mat<f64> {
    let mut load = Mat::zeros(dofs.own, 1);
    for e in 0..sector.mesh.elements.len() {
        let x = sector.mesh.corners(e);
        let mass = element::expand_nodal(&element::mass(&x, material.density), [1.0; 3]);
        let arm = Vector24::from_fn(|d, _| if d % 3 < 2 { x[d / 3][d % 3] } else { 0.0 });
        let f = element_frame(sector, e) * (mass * arm);
        for (d, row) in element_rows(sector, dofs, e).into_iter().enumerate() {
            if let Some(row) = row {
                load[(dofs.folded[row], 0)] += f[d];
            }
        }
    }
    load
}
