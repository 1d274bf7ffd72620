//! Free-interface modes: the lowest of a few nodal diameters of the full sector, in matrices small enough to be solved at any speed.
//!
//! The basis V of a nodal diameter spans its lowest modes at every given speed. At these speeds the Ritz values of
//!
//! ```text
//! (Vᴴ K̂(i, Ω) V − ω² Vᴴ M̂(i) V) c = 0
//! ```
//!
//! are the frequencies of the sector itself, and between them their error is that of the shapes squared.

use faer::sparse::SparseColMat;
use faer::{Mat, c64};

use super::findings::{InterpolationCheck, InterpolationVerdict};
use super::modes::{Modes, Pencil, Wanted};
use super::options::ReductionError;
use super::reduced::{ReducedHarmonic, ReducedWheel};
use super::sector_factor::SectorFactor;
use super::speed::search;
use super::untied::{Tie, UntiedSector};
use crate::dynamics::centrifugal::StiffnessPolynomial;
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::SectorModel;
use rubmap_numerics::orthonormal::orthonormal_basis;

/// Number of vectors advanced together in a search: the largest multiplicity of an eigenvalue that is found.
const BLOCK: usize = 4;
/// Residual of the modes: frequencies are right to some twelve digits, so that their differences are smooth.
const TOLERANCE: f64 = 1e-6;
/// Fraction of the largest singular value below which directions of the joint basis are dropped.
const DEPENDENT: f64 = 1e-5;

/// Lowest modes of a few nodal diameters of a full sector, with free contact DOF, at any speed.
#[derive(Debug, Clone)]
pub struct FreeInterfaceModes {
    /// Matrices in the unknowns of the nodal diameters that were asked for; others have no unknowns, and the list of contact nodes is empty.
    pub wheel: ReducedWheel,
    /// Shapes of the unknowns, by nodal diameter as asked for.
    pub shapes: Vec<FreeInterfaceShapes>,
}

/// Shapes of the unknowns of one nodal diameter, by which modes of two sectors with the same mesh can be compared.
#[derive(Debug, Clone)]
pub struct FreeInterfaceShapes {
    /// Nodal diameter i.
    pub nodal_diameter: usize,
    /// Displacement V of the own DOF, `n × unknowns`, mass-orthonormal.
    pub displacement: Mat<c64>,
    /// Momentum M̂V of the own DOF, `n × unknowns`.
    pub momentum: Mat<c64>,
}

/// Finds the lowest `count` modes of each of `nodal_diameters` of `sector`, which has no nodes on its axis, at the speeds of its stiffness matrices. Deterministic
/// for any number of threads.
///
/// # Errors
/// [`ReductionError::Model`] where the mass or the stiffness of a nodal diameter is not positive definite, or a search does not converge.
pub fn free_interface_modes(
    sector: &SectorModel,
    nodal_diameters: &[usize],
    count: usize,
) -> Result<FreeInterfaceModes, ReductionError> {
    let matrices: Vec<_> = std::iter::once(&sector.mass).chain(&sector.stiffness).collect();
    let untied = UntiedSector::new(sector, &matrices);
    let mass = untied.assemble(&[(1.0, &sector.mass)]);
    let stiffness: Vec<_> = sector.stiffness.iter().map(|matrix| untied.assemble(&[(1.0, matrix)])).collect();
    let ties: Vec<Tie> = nodal_diameters.iter().map(|&harmonic| untied.tie(harmonic)).collect();
    let mut found: Vec<Vec<Modes>> = vec![Vec::new(); ties.len()];
    for (stiffness, &speed_rad_s) in stiffness.iter().zip(&sector.speeds_rad_s) {
        let modes = modes_at(&untied, &mass, stiffness, nodal_diameters, count, speed_rad_s)?;
        found.iter_mut().zip(modes).for_each(|(found, modes)| found.push(modes));
    }
    let largest = nodal_diameters.iter().copied().max().unwrap_or(0);
    let mut harmonics: Vec<ReducedHarmonic> = (0..=largest).map(|h| reduced(h, Mat::new(), vec![])).collect();
    let mut shapes = Vec::with_capacity(ties.len());
    for (tie, modes) in ties.iter().zip(&found) {
        let count = modes.iter().map(|modes| modes.vectors.ncols()).sum();
        let mut joint = Mat::zeros(untied.internal() + untied.contact(), count);
        let mut first = 0;
        for modes in modes {
            joint.subcols_mut(first, modes.vectors.ncols()).copy_from(&modes.vectors);
            first += modes.vectors.ncols();
        }
        let gram = joint.adjoint() * untied.product(&mass, tie, joint.as_ref());
        let basis = orthonormal_basis(joint.as_ref(), gram.as_ref(), DEPENDENT)
            .ok_or(ModelError::MassNotPositiveDefinite { nodal_diameter: tie.harmonic })?;
        let momentum = untied.product(&mass, tie, basis.as_ref());
        let projected = |image: &Mat<c64>| {
            let full = basis.adjoint() * image;
            Mat::from_fn(full.nrows(), full.ncols(), |i, j| (full[(i, j)] + full[(j, i)].conj()) * 0.5)
        };
        let stiffness: Vec<Mat<c64>> =
            stiffness.iter().map(|matrix| projected(&untied.product(matrix, tie, basis.as_ref()))).collect();
        let polynomial = StiffnessPolynomial::fit(stiffness, &sector.speeds_rad_s);
        harmonics[tie.harmonic] = reduced(tie.harmonic, projected(&momentum), polynomial.coefficients);
        let by_dof = |tied: &Mat<c64>| {
            let rows: Vec<usize> = (0..sector.own_dofs()).map(|dof| untied.tied_row(tie, dof).0).collect();
            Mat::from_fn(rows.len(), tied.ncols(), |dof, column| tied[(rows[dof], column)])
        };
        shapes.push(FreeInterfaceShapes {
            nodal_diameter: tie.harmonic,
            displacement: by_dof(&basis),
            momentum: by_dof(&momentum),
        });
    }
    let wheel = ReducedWheel {
        sectors: sector.sectors,
        contact: Vec::new(),
        speeds_rad_s: sector.speeds_rad_s.clone(),
        harmonics,
        interpolation: InterpolationCheck {
            verdict: InterpolationVerdict::Absent,
            linear_ratio: 0.0,
            quadratic_ratio: 0.0,
            frequency_error: 0.0,
        },
        comparison: Vec::new(),
    };
    Ok(FreeInterfaceModes { wheel, shapes })
}

fn reduced(harmonic: usize, mass: Mat<c64>, coefficients: Vec<Mat<c64>>) -> ReducedHarmonic {
    let stiffness = StiffnessPolynomial { coefficients };
    ReducedHarmonic { harmonic, mass, stiffness, gyroscopic: None, certificates: Vec::new() }
}

/// Lowest modes of every nodal diameter at one stiffness.
fn modes_at(
    untied: &UntiedSector,
    mass: &SparseColMat<usize, f64>,
    stiffness: &SparseColMat<usize, f64>,
    nodal_diameters: &[usize],
    count: usize,
    speed_rad_s: f64,
) -> Result<Vec<Modes>, ReductionError> {
    let indefinite = |nodal_diameter: usize| ModelError::StiffnessNotPositiveDefinite {
        nodal_diameter,
        speed_rad_s,
        hint: "the sector would buckle under its own centrifugal load, or is not held",
    };
    let first = nodal_diameters.first().copied().unwrap_or(0);
    let factor = SectorFactor::new(untied, stiffness).map_err(|_| indefinite(first))?;
    let tied = nodal_diameters
        .iter()
        .map(|&harmonic| {
            let tied = factor.tie(stiffness, harmonic).map_err(|_| indefinite(harmonic))?;
            tied.free.map_err(|_| indefinite(harmonic))?;
            Ok(tied)
        })
        .collect::<Result<Vec<_>, ModelError>>()?;
    let wanted = Wanted { count, block: BLOCK, free: true, vectors: true, tolerance: TOLERANCE, beyond: 0 };
    let asked: Vec<_> = tied.iter().map(|tied| (tied, wanted)).collect();
    search(&Pencil { untied, stiffness, mass, factor: &factor }, &asked, speed_rad_s, &|_| true)
}
