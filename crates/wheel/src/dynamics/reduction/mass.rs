//! Check whether a mass can carry the modes of a sector.
//!
//! Modes are those of M x = θ K x with the largest θ = 1/λ, orthonormal in M. Directions without mass have θ = 0 and follow
//! statically, far from all modes that are kept: M need not be definite. Elements whose mass is integrated at few points
//! (C3D20R, C3D15) leave such directions, and round-off moves their zeros to either side. A mass that is negative by
//! more is not that of a structure.

use faer::sparse::{SparseColMat, Triplet};

use super::sector_factor::SectorFactor;
use super::untied::UntiedSector;
use crate::dynamics::sector::{CyclicMatrix, SectorModel};
use rubmap_numerics::sector_fourier::harmonic_count;

/// Size up to which eigenvalues of a mass scaled to a unit diagonal may be negative: what assembling and printing twelve digits leave of
/// zeros (−7.5e-12 seen of C3D15).
pub const ROUND_OFF: f64 = 1e-10;

/// Motion of the wheel whose mass is negative by more than [`ROUND_OFF`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NegativeMass {
    /// Nodal diameter of the motion.
    pub nodal_diameter: usize,
    /// Own DOF that takes part in the motion.
    pub dof: usize,
}

/// Looks for a [`NegativeMass`] by elimination of M + [`ROUND_OFF`] · diag(M), whose diagonal must be positive; not where
/// that takes more than `most_work` multiplications.
pub fn check_mass(sector: &SectorModel, most_work: f64) -> Result<(), NegativeMass> {
    let untied = UntiedSector::new(sector, &[&sector.mass]);
    let boundary = (untied.face() + untied.contact()) as f64;
    let harmonics = harmonic_count(sector.sectors);
    if untied.analysis.work() + harmonics as f64 * boundary.powi(3) > most_work {
        return Ok(());
    }
    let mass = untied.assemble(&[(1.0, &sector.mass), (ROUND_OFF, &diagonal(&sector.mass))]);
    let at = |nodal_diameter: usize, row: usize| NegativeMass { nodal_diameter, dof: untied.dof_of(row) };
    let factor = SectorFactor::new(&untied, &mass).map_err(|failed| at(0, failed.row))?;
    if factor.surely_definite(&mass) {
        return Ok(());
    }
    (0..harmonics).try_for_each(|harmonic| {
        let tied = factor.tie(&mass, harmonic).and_then(|tied| tied.free);
        tied.map_err(|failed| at(harmonic, failed.row))
    })
}

fn diagonal(matrix: &CyclicMatrix) -> CyclicMatrix {
    let size = matrix.own.ncols();
    let entries: Vec<_> = (matrix.own.triplet_iter())
        .filter(|entry| entry.row == entry.col)
        .map(|entry| Triplet::new(entry.row, entry.col, *entry.val))
        .collect();
    let square = |entries: &[Triplet<usize, usize, f64>]| {
        SparseColMat::try_new_from_triplets(size, size, entries)
            .unwrap_or_else(|_| unreachable!("rows and columns of a square matrix are in range"))
    };
    CyclicMatrix { own: square(&entries), next: square(&[]) }
}
