//! Checks of the matrices against the DOF table; those of the file readers are repeated for packages made in memory.

use crate::package::error::{ArchiveProblem, ManifestProblem, MatrixProblem, PackageError};
use crate::package::raw::{RawMatrix, RawPackage};
use crate::package::symmetric::{self, Mirror};

/// Checks sizes, ranges and values, and sorts entries by column, then row.
pub(super) fn check(package: &mut RawPackage) -> Result<(), PackageError> {
    let dofs = package.dofs.len();
    let names = &package.manifest;
    let symmetric = Mirror::Symmetric;
    check_one(&mut package.mass, symmetric, dofs)
        .map_err(|problem| PackageError::matrix(&names.mass, problem))?;
    if package.stiffness.len() != names.stiffness.len() {
        let (matrices, speeds) = (package.stiffness.len(), names.speeds_rad_s.len());
        let problem = ManifestProblem::StiffnessCount { matrices, speeds };
        return Err(PackageError::manifest("/stiffness", problem));
    }
    for (matrix, name) in package.stiffness.iter_mut().zip(&names.stiffness) {
        check_one(matrix, symmetric, dofs).map_err(|problem| PackageError::matrix(name, problem))?;
    }
    check_values(&package.mass).map_err(|problem| PackageError::matrix(&names.mass, problem))?;
    for (matrix, name) in package.stiffness.iter().zip(&names.stiffness) {
        check_values(matrix).map_err(|problem| PackageError::matrix(name, problem))?;
    }
    if let (Some(matrix), Some(name)) = (package.stiffness.first(), names.stiffness.first()) {
        check_diagonal(matrix).map_err(|problem| PackageError::matrix(name, problem))?;
    }
    match (&names.gyroscopic, &mut package.gyroscopic) {
        (Some(name), Some(matrix)) => {
            check_one(matrix, Mirror::Skew, dofs).map_err(|problem| PackageError::matrix(name, problem))
        }
        (Some(name), None) => {
            let problem = ManifestProblem::FileMissing { file: name.clone(), found_in: None };
            Err(PackageError::manifest("/gyroscopic", problem))
        }
        (None, Some(_)) => {
            Err(PackageError::archive("the gyroscopic matrix".to_owned(), ArchiveProblem::Surplus))
        }
        (None, None) => Ok(()),
    }
}

/// Magnitudes of largest entries that are accepted: beyond, their squares would leave the range of numbers.
const RANGE: [f64; 2] = [1e-60, 1e60];

/// Negative entries of a diagonal up to this part of its largest one are round-off.
const ROUND_OFF: f64 = 1e-9;

fn check_values(matrix: &RawMatrix) -> Result<(), MatrixProblem> {
    let largest = matrix.entries.iter().map(|entry| entry.2.abs()).fold(0.0, f64::max);
    let [least, most] = RANGE;
    match largest {
        0.0 => Err(MatrixProblem::AllZero),
        largest if !(least..=most).contains(&largest) => {
            Err(MatrixProblem::OutOfRange { largest, least, most })
        }
        _ => Ok(()),
    }
}

/// Checks the sign of the diagonal of the stiffness at rest.
fn check_diagonal(matrix: &RawMatrix) -> Result<(), MatrixProblem> {
    let diagonal = || matrix.entries.iter().filter(|entry| entry.0 == entry.1);
    let largest = diagonal().map(|entry| entry.2.abs()).fold(0.0, f64::max);
    match diagonal().find(|entry| entry.2 < -ROUND_OFF * largest) {
        Some(&(row, _, value)) => Err(MatrixProblem::NegativeDiagonal { row: u64::from(row) + 1, value }),
        None => Ok(()),
    }
}

fn check_one(matrix: &mut RawMatrix, mirror: Mirror, dofs: usize) -> Result<(), MatrixProblem> {
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
        *entry = mirror.folded(entry.0, entry.1, entry.2);
    }
    *matrix = symmetric::from_triangle(mirror, size, std::mem::take(&mut matrix.entries))?;
    Ok(())
}
