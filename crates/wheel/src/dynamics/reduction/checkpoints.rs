//! Where a long reduction keeps its parts, so that a restart continues, and its basis, so that nodes can be read.

use super::rows::BasisRows;

/// Keeps finished parts of one reduction under names like `speed-1-harmonic-3`, and what a finished one leaves beside it.
pub trait Checkpoints: Sync {
    /// The bytes kept under `part`, unchanged, or nothing.
    fn load(&self, part: &str) -> Option<Vec<u8>>;
    /// Keeps `bytes` under `part` as well as it can: losing them costs time, not correctness.
    fn save(&self, part: &str, bytes: Vec<u8>);
    /// Keeps what it wants of the basis of a nodal diameter, as well as it can; each comes once, when the reduction has
    /// succeeded there.
    fn keep_basis(&self, rows: &BasisRows<'_>);
}

/// Keeps nothing.
#[derive(Debug, Clone, Copy)]
pub struct NoCheckpoints;

impl Checkpoints for NoCheckpoints {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}

    fn keep_basis(&self, _rows: &BasisRows<'_>) {}
}
