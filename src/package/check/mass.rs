//! The mass of the assembled wheel must be positive definite.
//!
//! Three looks, from cheap to conclusive: the diagonal and the 2 × 2 minors of Y0 (a principal submatrix of the
//! wheel's mass) name the node to blame; then sparse Cholesky factorisations of all harmonic matrices M̂(i), which
//! together are the wheel. The last is done up to [`LARGEST_FACTORISED`] DOF; beyond, the reduction factors the mass itself.

use std::f64::consts::TAU;

use faer::Side;
use faer::c64;
use faer::sparse::linalg::LltError;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};

use crate::dynamics::sector::{CyclicMatrix, SectorModel};
use crate::package::error::{MatrixProblem, PackageError};

/// Own DOF above which no factorisation is made here.
const LARGEST_FACTORISED: usize = 20_000;

/// Smallest eigenvalue accepted of a mass scaled to a unit diagonal: below, it is singular within rounding.
const SMALLEST_EIGENVALUE: f64 = 1e-12;

/// Checks `sector.mass`; `rows` and `nodes` name the package row and node id of each own DOF.
pub(in crate::package) fn check(
    sector: &SectorModel,
    file: &str,
    rows: &[u32],
    nodes: &[u64],
) -> Result<(), PackageError> {
    let wrong = |problem| Err(PackageError::matrix(file, problem));
    let row_number = |dof: usize| rows[dof] as usize + 1;
    let diagonal = diagonal(&sector.mass.own);
    if let Some(dof) = diagonal.iter().position(|value| *value <= 0.0 || !value.is_finite()) {
        let problem =
            MatrixProblem::MassDiagonal { node: nodes[dof], row: row_number(dof), value: diagonal[dof] };
        return wrong(problem);
    }
    for triplet in sector.mass.own.triplet_iter().filter(|entry| entry.row > entry.col) {
        let (i, j, value) = (triplet.row, triplet.col, *triplet.val);
        if value.abs() >= diagonal[i].sqrt() * diagonal[j].sqrt() {
            return wrong(MatrixProblem::MassMinor {
                node: nodes[i],
                row: row_number(i),
                other_node: nodes[j],
                other_row: row_number(j),
                value,
            });
        }
    }
    if sector.own_dofs() <= LARGEST_FACTORISED
        && let Some(nodal_diameter) = first_indefinite(&sector.mass, &diagonal, sector.sectors)
    {
        return wrong(MatrixProblem::MassIndefinite { nodal_diameter });
    }
    Ok(())
}

fn diagonal(matrix: &SparseColMat<usize, f64>) -> Vec<f64> {
    let mut diagonal = vec![0.0; matrix.ncols()];
    for entry in matrix.triplet_iter().filter(|entry| entry.row == entry.col) {
        diagonal[entry.row] = *entry.val;
    }
    diagonal
}

/// The first nodal diameter whose M̂(i) is not positive definite.
///
/// Factorises D^{-1/2} M̂ D^{-1/2} less a little identity, so that units and mesh grading do not matter and a singular
/// matrix does not pass by rounding. Without coupling all harmonics are the same matrix.
fn first_indefinite(mass: &CyclicMatrix, diagonal: &[f64], sectors: usize) -> Option<usize> {
    let scale: Vec<f64> = diagonal.iter().map(|value| value.sqrt().recip()).collect();
    let last = if mass.next.val().is_empty() { 0 } else { sectors / 2 };
    let mut symbolic = None;
    (0..=last).find(|&nodal_diameter| {
        let angle = TAU * nodal_diameter as f64 / sectors as f64;
        let lower = scaled_harmonic(mass, &scale, c64::cis(angle));
        // The pattern is the same for all harmonics.
        let ordered = match symbolic.take() {
            Some(ordered) => Ok(ordered),
            None => SymbolicLlt::try_new(lower.symbolic(), Side::Lower),
        };
        let factor = ordered.map_err(LltError::from).and_then(|ordered| {
            symbolic = Some(ordered.clone());
            Llt::try_new_with_symbolic(ordered, lower.as_ref(), Side::Lower)
        });
        factor.is_err()
    })
}

/// Lower triangle of S (Y0 + Y1 p + Y1ᵀ p̄) S − ε I, with S = diag(`scale`) and p = `phase`.
fn scaled_harmonic(mass: &CyclicMatrix, scale: &[f64], phase: c64) -> SparseColMat<usize, c64> {
    let own = mass.own.triplet_iter().map(|entry| (entry.row, entry.col, c64::new(*entry.val, 0.0)));
    let next = mass.next.triplet_iter().flat_map(|entry| {
        let forward = phase * *entry.val;
        [(entry.row, entry.col, forward), (entry.col, entry.row, forward.conj())]
    });
    let lower = own.chain(next).filter(|(row, column, _)| row >= column);
    let scaled =
        lower.map(|(row, column, value)| Triplet::new(row, column, value * (scale[row] * scale[column])));
    let shift = (0..scale.len()).map(|dof| Triplet::new(dof, dof, c64::new(-SMALLEST_EIGENVALUE, 0.0)));
    let entries: Vec<_> = scaled.chain(shift).collect();
    match SparseColMat::try_new_from_triplets(scale.len(), scale.len(), &entries) {
        Ok(matrix) => matrix,
        Err(_) => unreachable!("rows and columns of a square matrix are in range"),
    }
}
