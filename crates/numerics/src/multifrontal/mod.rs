//! Partial factorisation of a sparse symmetric matrix by the multifrontal method (Duff and Reid, ACM TOMS 9, 1983).
//!
//! The leading rows are eliminated, the last ones (a boundary) are not; they are left with a dense Schur complement, so that one real factor serves
//! every nodal diameter. faer factors whole matrices; feral offers the same and takes five to eight times as long on our sectors.
//!
//! ```text
//! A = [ A_II  A_IF ]     A_II = L D Lᵀ     A_FI = L_F D Lᵀ     S = −A_FI A_II⁻¹ A_IF = −L_F D L_Fᵀ
//!     [ A_FI  ·    ]
//! ```
//!
//! L is unit lower triangular and D diagonal, without pivoting: as stable as Cholesky for a positive definite A_II
//! (D > 0), to be checked by its growth for any other. By Sylvester's law the negative entries of D count the negative
//! eigenvalues of A_II.

mod analysis;
mod eliminate;
mod eliminated;
mod factor;
mod slab;
mod solve;

pub use analysis::{Analysis, postorder};
pub use eliminated::Breakdown;
pub use factor::{Inertia, PartialFactor};

#[cfg(test)]
mod tests;
