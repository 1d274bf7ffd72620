//! What eliminating a front leaves.

use faer::Mat;

/// A pivot is exactly zero, or a number is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the factorisation broke down at row {row} of the elimination order")]
pub struct Breakdown {
    /// Row in elimination order.
    pub row: usize,
}

/// The answer of one front.
pub(super) struct Eliminated {
    /// Its columns of L, pivot rows first; the strict upper triangle of the pivot rows means nothing.
    pub(super) lower: Mat<f64>,
    /// Its part of D.
    pub(super) pivots: Vec<f64>,
    /// What it passes up, lower triangle.
    pub(super) update: Mat<f64>,
}
