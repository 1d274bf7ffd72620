//! What eliminating a front leaves.

use faer::Mat;

/// A pivot is exactly zero, or a number is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the factorisation broke down at row {row} of the elimination order")]
pub struct Breakdown {
    /// Row in elimination order.
    pub row: usize,
}

/// The answer of one front: its columns of L and the update it passes up.
pub(super) struct Eliminated {
    pub(super) front: usize,
    pub(super) lower: Mat<f64>,
    pub(super) pivots: Vec<f64>,
}
