//! Check of the mass of the assembled wheel, which must be able to carry modes: positive on the diagonal, and nowhere negative by more than
//! round-off.
//!
//! Three checks, from cheap to conclusive: the diagonal and the 2 × 2 minors of Y0 (a principal submatrix of the wheel's mass) name the
//! entries at fault; then the elimination with which a reduction begins. The last is done as long as it is quick; beyond that, the
//! reduction itself refuses.

use faer::sparse::SparseColMat;

use crate::package::error::{MatrixProblem, PackageError};
use rubmap_wheel::dynamics::reduction::mass::{NegativeMass, ROUND_OFF, check_mass};
use rubmap_wheel::dynamics::sector::SectorModel;

/// Largest number of multiplications that an upload may wait for: some seconds.
const MOST_WORK: f64 = 1e11;

/// Checks `sector.mass`; `rows` and `nodes` name the package row and node id of each own DOF.
pub(crate) fn check(
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
        if value.abs() > (1.0 + ROUND_OFF) * diagonal[i].sqrt() * diagonal[j].sqrt() {
            return wrong(MatrixProblem::MassMinor {
                node: nodes[i],
                row: row_number(i),
                other_node: nodes[j],
                other_row: row_number(j),
                value,
            });
        }
    }
    check_mass(sector, MOST_WORK).map_err(|NegativeMass { nodal_diameter, dof }| {
        let (node, row) = (nodes[dof], row_number(dof));
        PackageError::matrix(file, MatrixProblem::MassNegative { nodal_diameter, node, row })
    })
}

fn diagonal(matrix: &SparseColMat<usize, f64>) -> Vec<f64> {
    let mut diagonal = vec![0.0; matrix.ncols()];
    for entry in matrix.triplet_iter().filter(|entry| entry.row == entry.col) {
        diagonal[entry.row] = *entry.val;
    }
    diagonal
}
