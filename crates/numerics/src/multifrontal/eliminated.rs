//! Result of eliminating a front.

use faer::Mat;

/// Error: a pivot is exactly zero, or a number is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the factorisation broke down at row {row} of the elimination order")]
pub struct Breakdown {
    /// Row in elimination order.
    pub row: usize,
}

/// Result of eliminating one front.
pub(super) struct Eliminated {
    /// Columns of L of the front, pivot rows first; the strict upper triangle of the pivot rows means nothing.
    pub(super) lower: Mat<f64>,
    /// Entries of D of the front.
    pub(super) pivots: Vec<f64>,
    /// Update that the front passes up, lower triangle.
    pub(super) update: Mat<f64>,
}
