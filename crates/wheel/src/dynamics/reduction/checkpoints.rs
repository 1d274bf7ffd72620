//! Storage of the parts of a long reduction, so that a restart continues, and of its basis, so that nodes can be read.

use super::rows::BasisRows;

/// Storage of finished parts of one reduction under names like `speed-1-harmonic-3`, and of the basis of a finished one.
pub trait Checkpoints: Sync {
    /// Loads the bytes stored under `part`, unchanged, or nothing.
    fn load(&self, part: &str) -> Option<Vec<u8>>;
    /// Stores `bytes` under `part` as well as it can: losing them costs time, not correctness.
    fn save(&self, part: &str, bytes: Vec<u8>);
    /// Stores any rows of the basis of a nodal diameter, as well as it can; each nodal diameter comes once, when the reduction has succeeded there.
    fn keep_basis(&self, rows: &BasisRows<'_>);
}

/// Storage that stores nothing.
#[derive(Debug, Clone, Copy)]
pub struct NoCheckpoints;

impl Checkpoints for NoCheckpoints {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}

    fn keep_basis(&self, _rows: &BasisRows<'_>) {}
}
