//! Errors of the analysis: why a computation gave no result.

use serde::{Deserialize, Serialize};

/// Violation: a part of a request that cannot be met, at a JSON pointer into that request.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[error("{pointer}: {message}")]
pub struct Violation {
    /// RFC 6901 pointer to the offending field, for example `/integration/steps_per_revolution`.
    pub pointer: String,
    /// Sentence that says what is wrong and what would be right.
    pub message: String,
}

impl Violation {
    /// Violation at `pointer`.
    pub fn new(pointer: impl Into<String>, message: impl Into<String>) -> Self {
        Self { pointer: pointer.into(), message: message.into() }
    }
}

/// Reason why a computation gave no result.
#[derive(Debug, Clone, thiserror::Error)]
pub enum AnalysisError {
    /// Cancellation by the monitor.
    #[error("cancelled")]
    Cancelled,
    /// Refusal of a request that asks for something impossible.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Refused(Vec<Violation>),
    /// Error of a model that cannot be reduced or evaluated: the message says at which harmonic and speed, and why.
    #[error("{0}")]
    Model(#[from] rubmap_wheel::dynamics::error::ModelError),
    /// Reduction that needs more memory than it may take.
    #[error("the reduction needs about {} of memory and may take {}", Bytes(*.needed_bytes), Bytes(*.allowed_bytes))]
    Memory {
        /// Estimated peak of the memory, in bytes.
        needed_bytes: u64,
        /// Allowed memory, in bytes.
        allowed_bytes: u64,
    },
}

/// Number of bytes, in words.
struct Bytes(u64);

impl std::fmt::Display for Bytes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mib = self.0 as f64 / f64::from(1 << 20);
        if mib < 1024.0 { write!(f, "{mib:.1} MiB") } else { write!(f, "{:.1} GiB", mib / 1024.0) }
    }
}
