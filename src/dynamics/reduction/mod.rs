//! Modified Craig–Bampton reduction per nodal diameter (§4; Eqs 4–6).
//!
//! Contact DOF stay physical. The internal ones follow through the static modes at rest and an orthonormal basis of
//! the fixed-interface modes at all given speeds:
//!
//! ```text
//! Υ̂(i) = [ I       0  ]      Y_r(i) = Υ̂(i)ᴴ Ŷ(i) Υ̂(i)      Y = M, K0, K1, K2
//!        [ Ψ_s(0)  Ψ* ]
//! ```

mod basis;
mod checkpoints;
mod interpolation;

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};

use super::centrifugal::StiffnessPolynomial;
use super::cyclic::{HarmonicMatrix, Partition, harmonic_matrix};
use super::error::ModelError;
use super::modal_wheel::natural_frequencies;
use super::sector::{ContactNode, SectorModel};
use crate::numerics::matrix_serde;
use crate::numerics::sector_fourier::harmonic_count;
use crate::numerics::sparse_product::sparse_product;

pub use checkpoints::{Checkpoints, NoCheckpoints};
pub use interpolation::{InterpolationCheck, InterpolationVerdict};

/// Settings of the reduction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReductionOptions {
    /// Fixed-interface modes per given speed and nodal diameter: the accuracy dial k. All of them where a sector has
    /// fewer internal DOF.
    pub modes_per_speed: usize,
    /// Directions of the joint basis with a singular value below this fraction of the largest are dropped. 1e-5:
    /// smaller values keep nearly dependent directions, which only become the stiffest modes of the wheel and
    /// shrink the stable step (1560 unknowns: 1.9 times at 1e-8).
    pub basis_tolerance: f64,
    /// Bytes the reduction may take at its peak; `None` for no limit.
    pub memory_bytes: Option<u64>,
}

impl ReductionOptions {
    /// `modes_per_speed` modes with the default tolerance.
    pub fn new(modes_per_speed: usize) -> Self {
        Self { modes_per_speed, basis_tolerance: 1e-5, memory_bytes: None }
    }
}

/// Reduced matrices of one nodal diameter: contact DOF first (r, θ, z per node), then modal coordinates.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedHarmonic {
    /// Nodal diameter i.
    pub harmonic: usize,
    /// M_r, Hermitian.
    #[serde(with = "matrix_serde")]
    pub mass: Mat<c64>,
    /// K_r(Ω).
    pub stiffness: StiffnessPolynomial,
    /// Largest ‖Kx − λMx‖/‖Kx‖ of its fixed-interface modes.
    pub largest_mode_residual: f64,
}

/// The reduced wheel at every speed: all that simulations need of a sector.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedWheel {
    /// N.
    pub sectors: usize,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<ContactNode>,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// One per nodal diameter 0 … ⌊N/2⌋.
    pub harmonics: Vec<ReducedHarmonic>,
    /// How far K(Ω) can be trusted between the given speeds.
    pub interpolation: InterpolationCheck,
}

impl ReducedWheel {
    /// Number of contact DOF n_b of a sector.
    pub fn contact_dofs(&self) -> usize {
        3 * self.contact.len()
    }
}

/// Why a reduction ended without a result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    /// The model cannot be reduced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// It needs more memory than allowed; found out before anything is computed.
    #[error("the reduction needs {needed_bytes} bytes of memory; {allowed_bytes} are allowed")]
    Memory {
        /// Estimated peak.
        needed_bytes: u64,
        /// What it was allowed.
        allowed_bytes: u64,
    },
}

/// Watches a reduction: called with the share of work done and what comes next; `false` stops it.
pub type Watch<'a> = &'a (dyn Fn(f64, &str) -> bool + 'a);

/// Reduces `sector`. Deterministic; everything runs on the calling thread.
pub fn reduce(
    sector: &SectorModel,
    options: &ReductionOptions,
    checkpoints: &dyn Checkpoints,
    watch: Watch<'_>,
) -> Result<ReducedWheel, ReductionError> {
    check_memory(sector, options)?;
    let contact_dofs = sector.contact.iter().flat_map(|node| node.dofs).collect();
    let partition = Partition::new(sector.own_dofs(), contact_dofs);
    let count = harmonic_count(sector.sectors);
    let mut harmonics = Vec::with_capacity(count);
    for harmonic in 0..count {
        let scoped = |fraction: f64, phase: &str| {
            let text = format!("reduction, nodal diameter {harmonic}: {phase}");
            watch((harmonic as f64 + fraction) / count as f64, &text)
        };
        let part = format!("harmonic-{harmonic}");
        let kept = checkpoints.load(&part).and_then(|bytes| postcard::from_bytes(&bytes).ok());
        let reduced = match kept {
            Some(reduced) => reduced,
            None => {
                let reduced = reduce_harmonic(sector, harmonic, &partition, options, &scoped)?;
                if let Ok(bytes) = postcard::to_stdvec(&reduced) {
                    checkpoints.save(&part, bytes);
                }
                reduced
            }
        };
        harmonics.push(reduced);
    }
    let interpolation = interpolation::check(sector, &harmonics)?;
    Ok(ReducedWheel {
        sectors: sector.sectors,
        contact: sector.contact.clone(),
        speeds_rad_s: sector.speeds_rad_s.clone(),
        harmonics,
        interpolation,
    })
}

/// Refuses a reduction that would take more memory than allowed: some 100 bytes for each entry of the matrices, factors
/// included.
fn check_memory(sector: &SectorModel, options: &ReductionOptions) -> Result<(), ReductionError> {
    let entries: usize = sector.stiffness.iter().map(|k| k.own.compute_nnz()).sum();
    let needed_bytes = 100 * entries as u64;
    match options.memory_bytes {
        Some(allowed_bytes) if needed_bytes > allowed_bytes => {
            Err(ReductionError::Memory { needed_bytes, allowed_bytes })
        }
        _ => Ok(()),
    }
}

fn reduce_harmonic(
    sector: &SectorModel,
    harmonic: usize,
    partition: &Partition,
    options: &ReductionOptions,
    watch: Watch<'_>,
) -> Result<ReducedHarmonic, ReductionError> {
    let build = |matrix| harmonic_matrix(matrix, harmonic, sector.sectors, partition);
    let mass = build(&sector.mass);
    let stiffness: Vec<_> = sector.stiffness.iter().map(build).collect();
    let basis = basis::reduction_basis(sector, harmonic, partition, &mass, &stiffness, options, watch)?;
    let projected = stiffness.iter().map(|k| basis.project(k)).collect();
    let reduced = ReducedHarmonic {
        harmonic,
        mass: basis.project(&mass),
        stiffness: StiffnessPolynomial::fit(projected, &sector.speeds_rad_s),
        largest_mode_residual: basis.largest_mode_residual,
    };
    // A wheel that is not held at rest is no model at any speed.
    natural_frequencies(&reduced, 0.0, true)?;
    Ok(reduced)
}

/// Υ̂ without its identity block.
struct Basis {
    /// Ψ_s(0), `n_i × n_b`.
    static_modes: Mat<c64>,
    /// Ψ*, `n_i × r`, mass-orthonormal.
    modes: Mat<c64>,
    largest_mode_residual: f64,
}

impl Basis {
    /// Υ̂ᴴ Ŷ Υ̂, Hermitian to the last bit (Eq. 6).
    fn project(&self, y: &HarmonicMatrix) -> Mat<c64> {
        let (n_b, r) = (self.static_modes.ncols(), self.modes.ncols());
        let inner_static = sparse_product(&y.internal, self.static_modes.as_ref()) + y.coupling.to_dense();
        let inner_modes = sparse_product(&y.internal, self.modes.as_ref());
        let contact = y.contact.to_dense()
            + y.coupling.adjoint() * &self.static_modes
            + self.static_modes.adjoint() * &inner_static;
        let mixed = inner_static.adjoint() * &self.modes;
        let modal = self.modes.adjoint() * &inner_modes;
        let full = Mat::from_fn(n_b + r, n_b + r, |i, j| match (i < n_b, j < n_b) {
            (true, true) => contact[(i, j)],
            (true, false) => mixed[(i, j - n_b)],
            (false, true) => mixed[(j, i - n_b)].conj(),
            (false, false) => modal[(i - n_b, j - n_b)],
        });
        Mat::from_fn(n_b + r, n_b + r, |i, j| (full[(i, j)] + full[(j, i)].conj()) * 0.5)
    }
}
