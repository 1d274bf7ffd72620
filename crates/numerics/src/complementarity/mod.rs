//! The linear complementarity problem 0 ≤ λ ⊥ g = q + Wλ ≥ 0, solved exactly.
//!
//! W is a P-matrix: every principal minor is positive, so that the solution exists and is unique for every q (Cottle, Pang and Stone, The
//! Linear Complementarity Problem, 1992, theorem 3.3.7). Symmetric positive definite matrices are P-matrices; W of frictional contact is
//! one as long as the coefficient is small.
//!
//! - [`active_set`]: block principal pivoting, the solver for rigid obstacles;
//! - [`branches`]: block pivoting for obstacles that give way by a [`law`];
//! - [`disc`]: contact with Coulomb friction in the contact plane;
//! - [`factor`]: how W on an active set is factorised, Cholesky for symmetric W and LU for others.

pub mod active_set;
pub mod branches;
pub mod disc;
pub mod factor;
pub mod law;
#[cfg(test)]
mod tests;

/// P-matrix given by its entries.
pub trait ContactOperator {
    /// Number of rows (= columns).
    fn size(&self) -> usize;

    /// Entry W(i, j).
    fn entry(&self, i: usize, j: usize) -> f64;

    /// Writes `gap` = q + Wλ, λ given at the `active` indices and zero elsewhere. Entries that are positive whatever the signs of W's
    /// entries may keep the value of q instead: the solver needs to know no more of them.
    fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]);
}

/// No solution was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ComplementarityError {
    /// W restricted to an active set is not positive definite.
    #[error("the contact operator is not positive definite on {active} active nodes")]
    NotPositiveDefinite {
        /// Size of the active set.
        active: usize,
    },
    /// A minor of W is zero or negative: W is no P-matrix.
    #[error("the contact operator is not a P-matrix: its minor on {active} active nodes is not positive")]
    NotPMatrix {
        /// Size of the active set.
        active: usize,
    },
    /// The pivoting did not end within its bound: round-off is larger than the tolerance.
    #[error("the contact problem was not solved in {pivots} pivoting steps")]
    NotSolved {
        /// Pivoting steps taken.
        pivots: usize,
    },
    /// No forces keep all gaps open: nodes are pressed against each other, which a singular W cannot resolve.
    #[error("no contact forces keep all gaps open: {penetration:.1e} of penetration is left")]
    Infeasible {
        /// Largest violation of a gap, length.
        penetration: f64,
    },
}

/// Whether any value is below `limit`: lane by lane and without an early exit, so that it vectorises.
#[inline(always)]
pub fn any_below(values: &[f64], limit: f64) -> bool {
    let mut lanes = [limit; 8];
    let mut chunks = values.chunks_exact(8);
    for chunk in &mut chunks {
        for (low, &value) in lanes.iter_mut().zip(chunk) {
            *low = if value < *low { value } else { *low };
        }
    }
    let mut below = chunks.remainder().iter().any(|&value| value < limit);
    for low in lanes {
        below |= low < limit;
    }
    below
}
