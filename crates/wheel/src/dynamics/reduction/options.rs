//! What a reduction may do and why it may fail.

use crate::dynamics::error::ModelError;

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
    /// Bytes the reduction may use; it refuses to start where it needs more.
    pub memory_bytes: Option<u64>,
}

impl ReductionOptions {
    /// `modes_per_speed` modes with the default tolerance and no limit on memory.
    pub fn new(modes_per_speed: usize) -> Self {
        Self { modes_per_speed, basis_tolerance: 1e-5, memory_bytes: None }
    }
}

/// Why a reduction ended without a result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    /// The model cannot be reduced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It would not fit into the memory allowed.
    #[error("the reduction needs some {needed_bytes} bytes of memory, and {allowed_bytes} are allowed")]
    Memory {
        /// Estimate.
        needed_bytes: u64,
        /// From the options.
        allowed_bytes: u64,
    },
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// Watches a reduction: called with the share of work done and what comes next; `false` stops it.
pub type Watch<'a> = &'a (dyn Fn(f64, &str) -> bool + 'a);
