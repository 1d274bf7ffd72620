//! Options of a reduction, and its errors.

use crate::dynamics::error::ModelError;

/// Settings of the reduction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReductionOptions {
    /// Number of fixed-interface modes per given speed and nodal diameter: the accuracy dial k. All of them where a sector has fewer internal DOF.
    pub modes_per_speed: usize,
    /// Fraction of the largest singular value below which directions of the joint basis are dropped. 1e-5: smaller values keep nearly dependent
    /// directions, which only become the stiffest modes of the wheel and shrink the stable step (1560 unknowns: 1.9 times at 1e-8).
    pub basis_tolerance: f64,
    /// Memory that the reduction may use, bytes; it refuses to start where it needs more.
    pub memory_bytes: Option<u64>,
}

impl ReductionOptions {
    /// Options for `modes_per_speed` modes with the default tolerance and no limit on memory.
    pub fn new(modes_per_speed: usize) -> Self {
        Self { modes_per_speed, basis_tolerance: 1e-5, memory_bytes: None }
    }
}

/// Reason why a reduction ended without a result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    /// Model that cannot be reduced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Reduction that would not fit into the memory allowed.
    #[error("the reduction needs some {needed_bytes} bytes of memory, and {allowed_bytes} are allowed")]
    Memory {
        /// Estimated memory, bytes.
        needed_bytes: u64,
        /// Memory allowed by the options, bytes.
        allowed_bytes: u64,
    },
    /// Reduction that the caller stopped.
    #[error("cancelled")]
    Cancelled,
}

/// Watcher of a reduction: called with the share of work done and the name of the next part; `false` stops the reduction.
pub type Watch<'a> = &'a (dyn Fn(f64, &str) -> bool + 'a);
