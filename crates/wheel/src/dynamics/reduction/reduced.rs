//! Reduced wheel, from which all simulations of a model start.

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::count::Completeness;
use super::findings::{FrequencyComparison, InterpolationCheck};
use crate::dynamics::centrifugal::StiffnessPolynomial;
use crate::dynamics::sector::ContactNode;
use rubmap_numerics::matrix_serde;

/// Reduced matrices of one nodal diameter: contact DOF first (r, θ, z per node), then modal coordinates.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedHarmonic {
    /// Nodal diameter i.
    pub harmonic: usize,
    /// Mass M_r, Hermitian.
    #[serde(with = "matrix_serde")]
    pub mass: Mat<c64>,
    /// Stiffness K_r(Ω).
    pub stiffness: StiffnessPolynomial,
    /// Gyroscopic matrix G_r per unit speed, skew-Hermitian; absent if the sector has none.
    #[serde(with = "matrix_serde::option")]
    pub gyroscopic: Option<Mat<c64>>,
    /// Fixed-interface modes of the nodal diameter at each given speed, with the proof that they are the lowest ones.
    pub certificates: Vec<ModeCertificate>,
}

/// Fixed-interface modes of one nodal diameter at one given speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeCertificate {
    /// Speed of the stiffness, rad/s.
    pub speed_rad_s: f64,
    /// Eigenvalues λ = ω², ascending, (rad/s)².
    pub eigenvalues: Vec<f64>,
    /// Residual ‖Kx − λMx‖/‖Kx‖ of each mode.
    pub residuals: Vec<f64>,
    /// Proof that the modes are the lowest, as far as there is one.
    pub completeness: Completeness,
}

impl ReducedHarmonic {
    /// Largest residual ‖Kx − λMx‖/‖Kx‖ of the fixed-interface modes.
    pub fn largest_mode_residual(&self) -> f64 {
        self.certificates.iter().flat_map(|certificate| &certificate.residuals).fold(0.0, |m, &r| m.max(r))
    }

    /// Mark of the reduction: SHA-256 of M_r, which tells whether rows of a basis are those that the matrices were projected on.
    pub fn mark(&self) -> [u8; 32] {
        mark(&self.mass)
    }
}

/// Reduced wheel at every speed: all that simulations need of a sector.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedWheel {
    /// Number N of sectors.
    pub sectors: usize,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<ContactNode>,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Reduced matrices of every nodal diameter 0 … ⌊N/2⌋.
    pub harmonics: Vec<ReducedHarmonic>,
    /// Check whether K(Ω) can be trusted between the given speeds.
    pub interpolation: InterpolationCheck,
    /// Lowest frequencies beside those of the full sector, at the given speeds and between them.
    pub comparison: Vec<FrequencyComparison>,
}

impl ReducedWheel {
    /// Number of contact DOF n_b of a sector.
    pub fn contact_dofs(&self) -> usize {
        3 * self.contact.len()
    }
}

pub(super) fn mark(mass: &Mat<c64>) -> [u8; 32] {
    let mut digest = Sha256::new();
    for value in mass.col_iter().flat_map(|column| column.iter()) {
        digest.update(value.re.to_le_bytes());
        digest.update(value.im.to_le_bytes());
    }
    digest.finalize().into()
}
