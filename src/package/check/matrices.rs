//! The matrices against the DOF table; what a file reader has seen already is seen again for packages made in memory.

use crate::package::error::{MatrixProblem, PackageError};
use crate::package::raw::{RawMatrix, RawPackage};
use crate::package::symmetric;

/// Checks sizes, ranges and values, and sorts entries by column, then row.
pub(super) fn check(package: &mut RawPackage) -> Result<(), PackageError> {
    let dofs = package.dofs.len();
    let names = &package.manifest;
    check_one(&mut package.mass, dofs).map_err(|problem| PackageError::matrix(&names.mass, problem))?;
    if package.stiffness.len() != names.stiffness.len() {
        let (matrices, speeds) = (package.stiffness.len(), names.speeds_rad_s.len());
        let problem = crate::package::error::ManifestProblem::StiffnessCount { matrices, speeds };
        return Err(PackageError::manifest("/stiffness", problem));
    }
    for (matrix, name) in package.stiffness.iter_mut().zip(&names.stiffness) {
        check_one(matrix, dofs).map_err(|problem| PackageError::matrix(name, problem))?;
    }
    Ok(())
}

fn check_one(matrix: &mut RawMatrix, dofs: usize) -> Result<(), MatrixProblem> {
    let size = matrix.size;
    if size != dofs {
        return Err(MatrixProblem::SizeDisagrees { rows: size as u64, dofs });
    }
    for entry in &mut matrix.entries {
        let (row, column) = (u64::from(entry.0) + 1, u64::from(entry.1) + 1);
        if row.max(column) > size as u64 {
            return Err(MatrixProblem::IndexOutOfRange { row, column, size });
        }
        if !entry.2.is_finite() {
            return Err(MatrixProblem::NotFinite { row, column });
        }
        *entry = (entry.0.max(entry.1), entry.0.min(entry.1), entry.2);
    }
    *matrix = symmetric::from_triangle(size, std::mem::take(&mut matrix.entries))?;
    Ok(())
}
